// Which cell is under the pointer.

/// The ray at a place of a pane, x and y from -1 to 1.
function rayAt(camera, x, y) {
    const caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2(x, y), camera);
    return caster.ray;
}

/// The first facet that a ray meets, and where; null for none. cornersOf(facet, corners) fills in three places.
/// cull: facets that face the viewer are not drawn. seen(place, facet): whether it is not hidden or clipped away.
function hitOf(count, cornersOf, ray, {cull, seen}) {
    const corners = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
    const [a, b, c] = corners;
    const place = new THREE.Vector3();
    let nearest = null;
    for (let facet = 0; facet < count; ++facet) {
        cornersOf(facet, corners);
        const hit = cull ? ray.intersectTriangle(c, b, a, true, place) : ray.intersectTriangle(a, b, c, false, place);
        if (hit && seen(place, facet)) {
            const distance = place.distanceTo(ray.origin);
            if (!nearest || distance < nearest.distance) {
                nearest = {facet, place: place.clone(), distance};
            }
        }
    }
    return nearest;
}

/// The cell of the segment that is nearest, if it is within a few pixels.
function nearestLine(lines, pane, x, y) {
    const {width, height} = pane.element.getBoundingClientRect();
    const pixel = (pane.camera.right - pane.camera.left) / pane.camera.zoom / width;
    const place = new THREE.Vector3(x, y, 0).unproject(pane.camera).setZ(0);
    const closest = new THREE.Vector3();
    const segment = new THREE.Line3();
    let nearest = null;
    for (let k = 0; k < lines.count; ++k) {
        segment.start.fromArray(lines.position, 12 * k);
        segment.end.fromArray(lines.other, 12 * k);
        segment.closestPointToPoint(place, true, closest);
        const distance = closest.distanceTo(place) / pixel;
        if (distance < 10 && (!nearest || distance < nearest.distance)) {
            nearest = {cell: lines.cells[k], place: closest.clone(), distance};
        }
    }
    return nearest;
}

/// Calls use(x, y), from -1 to 1, for clicks and taps on a pane, not for drags.
function onTap(element, use) {
    let down = null;
    element.addEventListener("pointerdown", event => {
        down = {x: event.clientX, y: event.clientY};
    });
    element.addEventListener("pointerup", event => {
        if (down && Math.hypot(event.clientX - down.x, event.clientY - down.y) < 5) {
            const box = element.getBoundingClientRect();
            use(2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height);
        }
        down = null;
    });
}
