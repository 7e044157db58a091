// The panes: the boundary in space at the instant, and for D = 2 all of the side in space-time.

const centreOfBounds = new THREE.Vector3(...bounds.least.map((least, k) => (least + bounds.most[k]) / 2));
const extents = new THREE.Vector3(...bounds.most.map((most, k) => most - bounds.least[k]));
const frameColour = [128, 138, 148];

/// The twelve edges of a box, or the four of a rectangle.
function pushBox(lines, least, most) {
    const corner = bits => [0, 1, 2].map(k => bits >> k & 1 ? most[k] : least[k]);
    for (let from = 0; from < 8; ++from) {
        for (let k = 0; k < 3; ++k) {
            if (!(from >> k & 1) && most[k] > least[k]) {
                lines.push(corner(from), corner(from | 1 << k), -1, frameColour);
            }
        }
    }
    lines.finish();
}

/// A quadrilateral without edges, of no cell.
function pushQuad(facets, [a, b, c, d], colour) {
    const noEdges = [false, false, false];
    facets.push([...a, ...b, ...c], -1, colour, noEdges);
    facets.push([...a, ...c, ...d], -1, colour, noEdges);
}

function perspectivePane(element) {
    const camera = new THREE.PerspectiveCamera(28, 1, 0.01, 1000);
    camera.up.set(0, 0, 1);
    const pane = new Pane(element, camera, new THREE.OrbitControls(camera, element));
    pane.controls.enableKeys = false; // the page has its own
    pane.controls.screenSpacePanning = true;
    pane.resize = (width, height) => {
        camera.aspect = width / height;
        camera.updateProjectionMatrix();
    };
    pane.pixelsByLength = height => height / 2 / Math.tan(THREE.Math.degToRad(camera.fov / 2)) /
        camera.position.distanceTo(pane.controls.target);
    return pane;
}

/// Looks at a box from a direction, as near as all its corners allow.
function fitCamera({camera, controls}, least, most, direction, margin = 0.14) {
    const box = new THREE.Box3(new THREE.Vector3(...least), new THREE.Vector3(...most));
    const towards = direction.clone().normalize();
    const right = new THREE.Vector3().crossVectors(camera.up, towards).normalize();
    const above = new THREE.Vector3().crossVectors(towards, right);
    const slope = (1 - margin) * Math.tan(THREE.Math.degToRad(camera.fov / 2));
    const centre = box.getCenter(new THREE.Vector3());
    let distance = 0;
    for (let bits = 0; bits < 8; ++bits) {
        const corner = new THREE.Vector3(...["x", "y", "z"].map((axis, k) => (bits >> k & 1 ? box.max : box.min)[axis]));
        corner.sub(centre);
        const across = Math.max(Math.abs(corner.dot(above)), Math.abs(corner.dot(right)) / camera.aspect);
        distance = Math.max(distance, corner.dot(towards) + across / slope);
    }
    [camera.near, camera.far] = [distance / 100, distance * 20];
    camera.position.copy(towards).multiplyScalar(distance).add(centre);
    controls.target.copy(centre);
    controls.update();
}

/// D = 3: facets seen from inside the domain, so that near walls do not hide what is behind them.
class SolidView {
    constructor(element) {
        this.pane = perspectivePane(element);
        this.facets = this.pane.addFacets(new Facets(facetMaterial({lit: true, side: THREE.BackSide})));
        this.inside = this.pane.addFacets(new Facets(facetMaterial({lit: false, side: THREE.DoubleSide})));
        this.fill = this.pane.addFacets(new Facets(insideMaterial())); // the plane in the domain, where no cells are known
        this.parity = new THREE.Mesh(this.facets.mesh.geometry, parityMaterial(this.facets.mesh.material.uniforms.clip));
        this.parity.frustumCulled = false;
        this.parity.renderOrder = 1;
        this.fill.mesh.renderOrder = 2;
        this.pane.scene.add(this.parity);
        pushBox(this.pane.addLines(new Lines(1)), bounds.least, bounds.most);
        this.mark = this.pane.addLines(new Lines(3));
        this.cutter = new PlaneCut();
        this.drawn = [true, true, true];
        ["x", "y", "z"].forEach((axis, k) => this.pane.addWord(axis, this.axisEnd(k)));
        this.pane.reset = () => fitCamera(this.pane, bounds.least, bounds.most, new THREE.Vector3(0.5, -0.8, 0.42));
    }

    /// A little beyond the end of the box's edge along an axis.
    axisEnd(axis) {
        const place = new THREE.Vector3(...bounds.least);
        place.setComponent(axis, bounds.most[axis] + 0.04 * extents.length());
        return place;
    }

    begin() {
        [this.facets, this.inside, this.fill, this.mark].forEach(object => object.clear());
    }

    addFacet(cell, cut, colour) {
        for (let k = 0; k < 3; ++k) {
            const [i, j] = [(k + 1) % 3, (k + 2) % 3];
            this.drawn[k] = cut.lower[i] === cut.lower[j] || cut.upper[i] === cut.upper[j];
        }
        this.facets.push(cut.x, cell, colour, this.drawn);
        if (cell === state.marked) {
            this.markFacet(cut.x);
        }
    }

    markFacet(x) {
        for (let k = 0; k < 3; ++k) {
            if (this.drawn[k]) {
                const [i, j] = [(k + 1) % 3, (k + 2) % 3];
                this.mark.push(x.slice(3 * i, 3 * i + 3), x.slice(3 * j, 3 * j + 3), -1, theme.mark);
            }
        }
    }

    addInside(instant) {
        if (!state.clip.on) {
            return;
        }
        const {normal, distance} = state.clipPlane();
        if (knowsInside(instant)) {
            eachInside(instant, (cell, x) => this.cutter.cut(x, normal, distance,
                (corners, drawn) => this.inside.push(corners, cell, theme.inside, drawn)));
        } else if (state.shown.every(shown => shown)) { // else the boundary is not closed
            this.pushPlane(normal, distance);
        }
    }

    /// The part of the plane in the box.
    pushPlane(normal, distance) {
        const axis = state.clip.axis;
        const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        const corner = (a, b) => {
            const x = [0, 0, 0];
            [x[axis], x[u], x[v]] = [normal.getComponent(axis) * distance, a[u], b[v]];
            return x;
        };
        const {least, most} = bounds;
        const corners = [corner(least, least), corner(most, least), corner(most, most), corner(least, most)];
        pushQuad(this.fill, corners, theme.solid);
    }

    finish() {
        const {normal, distance} = state.clipPlane();
        const clip = this.facets.mesh.material.uniforms.clip.value;
        state.clip.on ? clip.set(normal.x, normal.y, normal.z, distance) : clip.set(0, 0, 0, 1);
        const darkness = state.edges ? 0.7 : 0;
        this.facets.setEdges(darkness, theme.edge);
        this.inside.setEdges(darkness, theme.insideEdge);
        [this.facets, this.inside, this.fill].forEach(facets => facets.finish());
        this.facets.mesh.material.side = this.culls() ? THREE.BackSide : THREE.DoubleSide;
        this.mark.finish();
        this.parity.geometry = this.facets.mesh.geometry;
        this.parity.visible = this.fill.count > 0 && this.facets.count > 0;
    }

    /// What is clipped is solid: nothing of it hides what is to be seen.
    culls() {
        return state.cull && !state.clip.on;
    }

    pick(x, y) {
        const {normal, distance} = state.clipPlane();
        const cornersOf = (facet, corners) => corners.forEach((corner, k) =>
            corner.fromArray(this.facets.position, 9 * facet + 3 * k));
        const hit = hitOf(this.facets.count, cornersOf, rayAt(this.pane.camera, x, y), {cull: this.culls(),
            seen: place => !state.clip.on || normal.dot(place) <= distance});
        return hit && {cell: this.facets.cells[hit.facet], place: hit.place};
    }
}

/// D = 2: curves in the plane, and the mesh inside where it is known.
class PlaneView {
    constructor(element) {
        const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1, 1);
        this.pane = new Pane(element, camera, new THREE.OrbitControls(camera, element));
        this.lines = new Lines(2.5);
        this.mark = new Lines(6);
        this.inside = this.pane.addFacets(new Facets(facetMaterial({lit: false, side: THREE.DoubleSide})));
        this.drawn = [true, true, true];
        this.triangle = new Float64Array(9);
        this.fans = new Facets(parityMaterial({value: new THREE.Vector4(0, 0, 0, 1)}));
        this.pane.scene.add(this.fans.mesh);
        this.fill = this.pane.addFacets(new Facets(insideMaterial()));
        this.pane.addLines(this.mark);
        this.pane.addLines(this.lines);
        [this.fans, this.fill, this.inside, this.mark, this.lines].forEach((object, order) => {
            object.mesh.renderOrder = order;
            object.mesh.material.depthTest = false;
        });
        this.setControls();
    }

    setControls() {
        const {camera, controls} = this.pane;
        controls.enableRotate = false;
        controls.enableKeys = false;
        controls.screenSpacePanning = true;
        controls.mouseButtons = {LEFT: THREE.MOUSE.PAN, MIDDLE: THREE.MOUSE.DOLLY, RIGHT: THREE.MOUSE.PAN};
        controls.touches = {ONE: THREE.TOUCH.PAN, TWO: THREE.TOUCH.DOLLY_PAN};
        this.pane.resize = (width, height) => {
            const half = 0.54 * Math.max(extents.y, extents.x * height / width);
            [camera.top, camera.bottom] = [half, -half];
            [camera.left, camera.right] = [-half * width / height, half * width / height];
            camera.updateProjectionMatrix();
        };
        this.pane.pixelsByLength = height => camera.zoom * height / (camera.top - camera.bottom);
        this.pane.reset = () => {
            camera.position.set(centreOfBounds.x, centreOfBounds.y, 0.5);
            camera.zoom = 1;
            camera.updateProjectionMatrix();
            controls.target.set(centreOfBounds.x, centreOfBounds.y, 0);
            controls.update();
        };
    }

    begin() {
        [this.fans, this.fill, this.inside, this.mark, this.lines].forEach(object => object.clear());
    }

    addFacet(cell, cut, colour) {
        const [from, to] = [[cut.x[0], cut.x[1], 0], [cut.x[3], cut.x[4], 0]];
        this.lines.push(from, to, cell, colour);
        this.fans.push([...from, ...to, 0, 0, 0], cell, colour, this.drawn);
        if (cell === state.marked) {
            this.mark.push(from, to, cell, theme.mark);
        }
    }

    addInside(instant) {
        if (state.inside && knowsInside(instant)) {
            eachInside(instant, (cell, x) => this.inside.push(x, cell, theme.inside, this.drawn));
        } else if (state.shown.every(shown => shown)) {
            const {least, most} = bounds;
            pushQuad(this.fill, [[least[0], least[1], 0], [most[0], least[1], 0], [most[0], most[1], 0],
                [least[0], most[1], 0]], theme.domain);
        }
    }

    finish() {
        this.inside.setEdges(state.edges ? 0.6 : 0, theme.insideEdge);
        [this.fans, this.fill, this.inside, this.mark, this.lines].forEach(object => object.finish());
    }

    pick(x, y) {
        return nearestLine(this.lines, this.pane, x, y);
    }
}

/// D = 2: the side in (x, y, t), with the instant as a plane.
class SpaceTimeView {
    constructor(element) {
        this.pane = perspectivePane(element);
        this.scale = 0.8 * Math.max(extents.x, extents.y) / (span.last - span.first);
        this.height = this.scale * (span.last - span.first);
        this.places = this.placesInSpaceTime();
        this.surface = side.count > SpaceTimeView.mostWithEdges ? new SharedSurface(this.places)
            : new FacetSurface(this.places);
        this.pane.addFacets(this.surface);
        this.pane.still = new Still();
        this.pane.still.scene.add(this.surface.mesh);
        this.pane.scene.add(this.pane.still.screen);
        this.lines = new Lines(3);
        this.plane = this.makePlane();
        this.pane.scene.add(this.plane);
        pushBox(this.pane.addLines(new Lines(1)), [bounds.least[0], bounds.least[1], 0],
            [bounds.most[0], bounds.most[1], this.height]);
        this.pane.addLines(this.lines);
        this.addWords();
        this.pane.reset = () => fitCamera(this.pane, [bounds.least[0], bounds.least[1], 0],
            [bounds.most[0], bounds.most[1], this.height], new THREE.Vector3(0.55, -0.9, 0.5), 0.22);
    }

    makePlane() {
        const material = new THREE.MeshBasicMaterial({color: 0x7f8b99, opacity: 0.28, transparent: true,
            side: THREE.DoubleSide, depthWrite: false});
        const plane = new THREE.Mesh(new THREE.PlaneBufferGeometry(1.06 * extents.x, 1.06 * extents.y), material);
        plane.position.copy(centreOfBounds);
        return plane;
    }

    addWords() {
        const away = 0.05 * Math.max(extents.x, extents.y);
        const [left, front] = bounds.least;
        const word = (text, x, y, z) => this.pane.addWord(text, new THREE.Vector3(x, y, z));
        word("x", bounds.most[0] + away, front, 0);
        word("y", left, bounds.most[1] + away, 0);
        const timeWord = (time, z) =>
            this.pane.addWord(`t = ${shortNumber(time)}`, new THREE.Vector3(left - away / 2, front, z), true);
        timeWord(span.first, 0);
        timeWord(span.last, this.height);
    }

    heightOf(time) {
        return this.scale * (time - span.first);
    }

    /// Of all vertices, three coordinates each.
    placesInSpaceTime() {
        const places = new Float32Array(3 * head.vertices);
        for (let v = 0; v < head.vertices; ++v) {
            places[3 * v] = points[2 * v];
            places[3 * v + 1] = points[2 * v + 1];
            places[3 * v + 2] = this.heightOf(times[timeOfVertex[v]]);
        }
        return places;
    }

    /// When colours or what is seen change, not with time.
    paint() {
        this.surface.paintAll();
        this.pane.still.outdated = true;
    }

    begin(instant) {
        this.lines.clear();
        this.plane.position.z = this.heightOf(instant.time);
    }

    addFacet(cell, cut) {
        const z = this.plane.position.z;
        this.lines.push([cut.x[0], cut.x[1], z], [cut.x[3], cut.x[4], z], cell, theme.instant);
    }

    addInside() {}

    finish() {
        this.surface.setEdges(state.edges ? 0.5 : 0, theme.edge);
        this.surface.mesh.material.side = state.cull ? THREE.BackSide : THREE.DoubleSide;
        this.lines.finish();
    }

    pick(x, y) {
        const cornersOf = (cell, corners) => corners.forEach((corner, k) =>
            corner.fromArray(this.places, 3 * side.vertices[3 * cell + k]));
        const hit = hitOf(side.count, cornersOf, rayAt(this.pane.camera, x, y), {cull: state.cull,
            seen: (_, cell) => state.shown[sidePatch[cell]]});
        return hit && {cell: hit.facet, place: hit.place};
    }
}
SpaceTimeView.mostWithEdges = 40000;
