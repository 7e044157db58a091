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

function perspectivePane(element) {
    const camera = new THREE.PerspectiveCamera(28, 1, 0.01, 1000);
    camera.up.set(0, 0, 1);
    const pane = new Pane(element, camera, new THREE.OrbitControls(camera, element));
    pane.controls.enableKeys = false; // the page has its own
    pane.controls.screenSpacePanning = true;
    pane.resize = (width, height) => {
        camera.aspect = width / height;
        camera.fov = 28 * Math.max(1, Math.min(2.2, height / width));
        camera.updateProjectionMatrix();
    };
    pane.fit = (centre, radius, direction) => {
        const distance = 1.06 * radius / Math.sin(THREE.Math.degToRad(camera.fov / 2));
        camera.near = distance / 200;
        camera.far = distance * 20;
        camera.position.copy(direction).setLength(distance).add(centre);
        pane.controls.target.copy(centre);
        pane.controls.update();
        stage.ask();
    };
    return pane;
}

/// D = 3: facets seen from inside the domain, so that near walls do not hide what is behind them.
class SolidView {
    constructor(element) {
        this.pane = perspectivePane(element);
        this.facets = new Facets(facetMaterial({lit: true, side: THREE.BackSide}));
        this.inside = new Facets(facetMaterial({lit: false, side: THREE.DoubleSide}));
        this.pane.scene.add(this.facets.mesh, this.inside.mesh);
        pushBox(this.pane.addLines(new Lines(1)), bounds.least, bounds.most);
        this.mark = this.pane.addLines(new Lines(3));
        this.cutter = new PlaneCut();
        this.drawn = [true, true, true];
        ["x", "y", "z"].forEach((axis, k) => this.pane.addWord(axis, this.axisEnd(k)));
        this.reset();
    }

    /// A little beyond the end of the box's edge along an axis.
    axisEnd(axis) {
        const place = new THREE.Vector3(...bounds.least);
        place.setComponent(axis, bounds.most[axis] + 0.04 * extents.length());
        return place;
    }

    reset() {
        this.pane.fit(centreOfBounds, extents.length() / 2, new THREE.Vector3(0.5, -0.8, 0.42));
    }

    begin() {
        this.facets.clear();
        this.inside.clear();
        this.mark.clear();
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
        if (state.clip.on && knowsInside(instant)) {
            const {normal, distance} = state.clipPlane();
            eachInside(instant, (cell, x) => this.cutter.cut(x, normal, distance,
                (corners, drawn) => this.inside.push(corners, cell, theme.inside, drawn)));
        }
    }

    finish() {
        const {normal, distance} = state.clipPlane();
        const clip = this.facets.mesh.material.uniforms.clip.value;
        state.clip.on ? clip.set(normal.x, normal.y, normal.z, distance) : clip.set(0, 0, 0, 1);
        for (const facets of [this.facets, this.inside]) {
            const {edges, edgePaint} = facets.mesh.material.uniforms;
            edges.value = state.edges ? 0.75 : 0;
            edgePaint.value.setRGB(...theme.edge);
            facets.finish();
        }
        this.facets.mesh.material.side = state.cull ? THREE.BackSide : THREE.DoubleSide;
        this.mark.finish();
    }

    pick(x, y) {
        const {normal, distance} = state.clipPlane();
        return hitOfFacets(this.facets, rayAt(this.pane.camera, x, y),
            {cull: state.cull, seen: place => !state.clip.on || normal.dot(place) <= distance});
    }
}

/// D = 2: curves in the plane, and the mesh inside where it is known.
class PlaneView {
    constructor(element) {
        const camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1, 1);
        this.pane = new Pane(element, camera, new THREE.OrbitControls(camera, element));
        this.lines = new Lines(2.5);
        this.mark = new Lines(6);
        this.inside = new Facets(facetMaterial({lit: false, side: THREE.DoubleSide}));
        this.drawn = [true, true, true];
        this.triangle = new Float64Array(9);
        this.pane.scene.add(this.inside.mesh);
        this.pane.addLines(this.mark);
        this.pane.addLines(this.lines);
        this.lines.mesh.renderOrder = 2;
        this.mark.mesh.renderOrder = 1;
        for (const object of [this.inside, this.mark, this.lines]) {
            object.mesh.material.depthTest = false;
        }
        this.setControls();
        this.reset();
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
    }

    reset() {
        const {camera, controls} = this.pane;
        camera.position.set(centreOfBounds.x, centreOfBounds.y, 0.5);
        camera.zoom = 1;
        controls.target.set(centreOfBounds.x, centreOfBounds.y, 0);
        controls.update();
        stage.ask();
    }

    begin() {
        this.lines.clear();
        this.mark.clear();
        this.inside.clear();
    }

    addFacet(cell, cut, colour) {
        const [from, to] = [[cut.x[0], cut.x[1], 0], [cut.x[3], cut.x[4], 0]];
        this.lines.push(from, to, cell, colour);
        if (cell === state.marked) {
            this.mark.push(from, to, cell, theme.mark);
        }
    }

    addInside(instant) {
        if (state.inside && knowsInside(instant)) {
            eachInside(instant, (cell, x) => this.inside.push(x, cell, theme.inside, this.drawn));
        }
    }

    finish() {
        const {edges, edgePaint} = this.inside.mesh.material.uniforms;
        edges.value = state.edges ? 0.6 : 0;
        edgePaint.value.setRGB(...theme.edge);
        [this.inside, this.mark, this.lines].forEach(object => object.finish());
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
        this.facets = new Facets(facetMaterial({lit: true, side: THREE.BackSide}));
        this.lines = new Lines(3);
        this.plane = this.makePlane();
        this.pane.scene.add(this.facets.mesh, this.plane);
        pushBox(this.pane.addLines(new Lines(1)), [bounds.least[0], bounds.least[1], 0],
            [bounds.most[0], bounds.most[1], this.height]);
        this.pane.addLines(this.lines);
        this.addWords();
        this.reset();
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
        word(`t = ${shortNumber(span.first)}`, left - away, front - away, 0);
        word(`t = ${shortNumber(span.last)}`, left - away, front - away, this.height);
    }

    reset() {
        const centre = centreOfBounds.clone().setZ(this.height / 2);
        const radius = Math.hypot(extents.x, extents.y, this.height) / 2;
        this.pane.fit(centre, radius, new THREE.Vector3(0.55, -0.9, 0.5));
    }

    heightOf(time) {
        return this.scale * (time - span.first);
    }

    /// All side cells of patches that are to be seen, in their colours: when these change, not with time.
    paint() {
        this.facets.clear();
        const x = new Float64Array(9);
        const drawn = [true, true, true];
        for (let cell = 0; cell < side.count; ++cell) {
            if (state.shown[sidePatch[cell]]) {
                this.copyCell(cell, x);
                this.facets.push(x, cell, state.colourOf(cell), drawn);
            }
        }
        this.facets.finish();
    }

    copyCell(cell, x) {
        for (let i = 0; i < 3; ++i) {
            const vertex = side.vertices[3 * cell + i];
            x[3 * i] = points[2 * vertex];
            x[3 * i + 1] = points[2 * vertex + 1];
            x[3 * i + 2] = this.heightOf(times[timeOfVertex[vertex]]);
        }
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
        const {edges, edgePaint} = this.facets.mesh.material.uniforms;
        edges.value = state.edges ? 0.5 : 0;
        edgePaint.value.setRGB(...theme.edge);
        this.facets.mesh.material.side = state.cull ? THREE.BackSide : THREE.DoubleSide;
        this.lines.finish();
    }

    pick(x, y) {
        return hitOfFacets(this.facets, rayAt(this.pane.camera, x, y), {cull: state.cull, seen: () => true});
    }
}
