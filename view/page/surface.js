// The side in space-time, for D = 2: triangles of patches that are to be seen, in their colours.

/// Each triangle with its own corners, for edges and sharp changes of colour.
class FacetSurface extends Facets {
    constructor(places) { // of the vertices, three coordinates each
        super(facetMaterial({lit: true, side: THREE.BackSide}));
        this.places = places;
    }

    paintAll() {
        const x = new Float32Array(9);
        const drawn = [true, true, true];
        this.clear();
        for (let cell = 0; cell < side.count; ++cell) {
            if (state.shown[sidePatch[cell]]) {
                for (let i = 0; i < 9; ++i) {
                    x[i] = this.places[3 * side.vertices[3 * cell + Math.floor(i / 3)] + i % 3];
                }
                this.push(x, cell, state.colourOf(cell), drawn);
            }
        }
        this.finish();
    }
}

/// Triangles that share corners, a sixth of the work for as many. A corner has the colour of one of its cells, and there
/// are no edges: they would be too close to be seen.
class SharedSurface {
    constructor(places) {
        this.geometry = new THREE.BufferGeometry();
        this.colours = new Uint8Array(4 * head.vertices);
        this.geometry.setAttribute("position", new THREE.BufferAttribute(places, 3));
        this.geometry.setAttribute("paint", new THREE.BufferAttribute(this.colours, 4, true));
        this.mesh = new THREE.Mesh(this.geometry, facetMaterial({lit: true, side: THREE.BackSide}));
        this.mesh.frustumCulled = false;
    }

    paintAll() {
        const seen = state.shown.every(shown => shown) ? side.vertices : this.seenVertices();
        for (let cell = 0; cell < side.count; ++cell) {
            const colour = state.colourOf(cell);
            for (let k = 3 * cell; k < 3 * cell + 3; ++k) {
                const at = 4 * side.vertices[k];
                this.colours[at] = colour[0];
                this.colours[at + 1] = colour[1];
                this.colours[at + 2] = colour[2];
            }
        }
        this.geometry.attributes.paint.needsUpdate = true;
        this.geometry.setIndex(new THREE.BufferAttribute(seen, 1));
    }

    seenVertices() {
        return side.vertices.filter((_, k) => state.shown[sidePatch[Math.floor(k / 3)]]);
    }

    setEdges() {}

    fadeEdges() {}
}
