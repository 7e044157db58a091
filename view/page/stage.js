// What is drawn: buffers of facets and of lines, and panes with a scene and a camera each.

const facetShader = {
    vertex: `
        attribute vec3 paint;
        attribute vec3 edge;
        varying vec3 vPaint;
        varying vec3 vEdge;
        varying vec3 vPlace;
        varying vec3 vView;
        void main() {
            vPaint = paint;
            vEdge = edge;
            vPlace = position;
            vec4 view = modelViewMatrix * vec4(position, 1.0);
            vView = view.xyz;
            gl_Position = projectionMatrix * view;
        }`,
    fragment: `
        uniform vec4 clip;      // seen is where clip.xyz . x <= clip.w
        uniform float lit;
        uniform float edges;    // how dark they are
        uniform vec3 edgePaint;
        uniform float opacity;
        varying vec3 vPaint;
        varying vec3 vEdge;
        varying vec3 vPlace;
        varying vec3 vView;
        float nearEdge() {
            vec3 width = fwidth(vEdge);
            vec3 away = min(vEdge / max(1.2 * width, vec3(1e-4)), 1.0); // no width: an edge that is not drawn
            float small = max(max(width.x, width.y), width.z); // facets of few pixels would be all edge
            return (1.0 - min(min(away.x, away.y), away.z)) * clamp(1.5 - 4.0 * small, 0.0, 1.0);
        }
        void main() {
            if (dot(clip.xyz, vPlace) > clip.w) {
                discard;
            }
            vec3 normal = normalize(cross(dFdx(vView), dFdy(vView)));
            float light = 0.52 + 0.48 * max(0.0, dot(normal, normalize(vec3(0.35, 0.5, 0.9))));
            vec3 seen = vPaint * mix(1.0, light, lit);
            gl_FragColor = vec4(mix(seen, edgePaint, edges * nearEdge()), opacity);
        }`,
};

const parityShader = {
    vertex: `
        varying vec3 vPlace;
        void main() {
            vPlace = position;
            gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
        }`,
    fragment: `
        uniform vec4 clip;
        varying vec3 vPlace;
        void main() {
            if (dot(clip.xyz, vPlace) > clip.w) {
                discard;
            }
            gl_FragColor = vec4(0.0);
        }`,
};

/// A picture with its depths.
const stillShader = {
    vertex: `
        varying vec2 vPlace;
        void main() {
            vPlace = position.xy / 2.0 + 0.5;
            gl_Position = vec4(position.xy, 0.0, 1.0);
        }`,
    fragment: `
        uniform sampler2D picture;
        uniform sampler2D depths;
        varying vec2 vPlace;
        void main() {
            gl_FragColor = texture2D(picture, vPlace);
            gl_FragDepthEXT = texture2D(depths, vPlace).r;
        }`,
};

const lineShader = {
    vertex: `
        attribute vec3 other;
        attribute float across;
        attribute vec3 paint;
        uniform vec2 size;      // of the pane, in pixels of CSS
        uniform float width;
        varying vec3 vPaint;
        void main() {
            vPaint = paint;
            vec4 here = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
            vec4 there = projectionMatrix * modelViewMatrix * vec4(other, 1.0);
            vec2 along = (there.xy / there.w - here.xy / here.w) * size;
            along = length(along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
            vec2 aside = vec2(-along.y, along.x) * across - 0.4 * along;
            gl_Position = here;
            gl_Position.xy += aside * width / size * here.w;
            gl_Position.z -= 0.0005 * here.w;
        }`,
    fragment: `
        varying vec3 vPaint;
        void main() {
            gl_FragColor = vec4(vPaint, 1.0);
        }`,
};

function facetMaterial({lit, side}) {
    return new THREE.ShaderMaterial({
        vertexShader: facetShader.vertex,
        fragmentShader: facetShader.fragment,
        extensions: {derivatives: true},
        side,
        uniforms: {
            clip: {value: new THREE.Vector4(0, 0, 0, 1)},
            lit: {value: lit ? 1 : 0},
            edges: {value: 0},
            edgePaint: {value: new THREE.Color(0, 0, 0)},
            opacity: {value: 1},
        },
    });
}

/// Turns a bit of each pixel over for each facet there, seen or not: it ends as 1 where their number is odd, which is
/// inside a closed boundary. Draws nothing.
function parityMaterial(clip) {
    const material = new THREE.ShaderMaterial({vertexShader: parityShader.vertex, fragmentShader: parityShader.fragment,
        side: THREE.DoubleSide, uniforms: {clip}});
    material.colorWrite = material.depthWrite = material.depthTest = false;
    material.stencilWrite = true;
    material.stencilFunc = THREE.AlwaysStencilFunc;
    material.stencilZPass = material.stencilZFail = THREE.InvertStencilOp;
    return material;
}

/// Draws where that bit is 1.
function insideMaterial() {
    const material = facetMaterial({lit: false, side: THREE.DoubleSide});
    material.stencilWrite = true;
    material.stencilRef = 0;
    material.stencilFunc = THREE.NotEqualStencilFunc;
    return material;
}

function lineMaterial(width) {
    return new THREE.ShaderMaterial({
        vertexShader: lineShader.vertex,
        fragmentShader: lineShader.fragment,
        side: THREE.DoubleSide,
        uniforms: {size: {value: new THREE.Vector2(1, 1)}, width: {value: width}},
    });
}

/// Arrays of a geometry that is filled anew again and again. They grow, never shrink.
class GrowingGeometry {
    constructor(material, layout) { // layout: [name, components, array type, normalised], of each vertex
        this.layout = layout;
        this.vertices = 0;
        this.capacity = 0;
        this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
        this.mesh.frustumCulled = false;
        this.reserve(1024);
    }

    reserve(vertices) {
        if (vertices <= this.capacity) {
            return;
        }
        this.capacity = 4 * Math.ceil(Math.max(vertices, 2 * this.capacity) / 4);
        const old = this.mesh.geometry;
        this.mesh.geometry = new THREE.BufferGeometry();
        for (const [name, components, type, normalised] of this.layout) {
            const array = new type(this.capacity * components);
            if (old.attributes[name]) {
                array.set(old.attributes[name].array);
            }
            const attribute = new THREE.BufferAttribute(array, components, normalised);
            attribute.setUsage(THREE.DynamicDrawUsage);
            this.mesh.geometry.setAttribute(name, attribute);
            this[name] = array;
        }
        old.dispose();
    }

    clear() {
        this.vertices = 0;
    }

    /// To be called when all is in place.
    finish() {
        for (const [name, components] of this.layout) {
            const attribute = this.mesh.geometry.attributes[name];
            attribute.updateRange = {offset: 0, count: this.vertices * components};
            attribute.needsUpdate = true;
        }
        this.mesh.geometry.setDrawRange(0, this.vertices);
        this.mesh.visible = this.vertices > 0;
    }
}

/// Triangles with a colour and a cell each, and edges that are drawn or not.
class Facets extends GrowingGeometry {
    constructor(material) {
        super(material, [["position", 3, Float32Array, false], ["paint", 4, Uint8Array, true],
            ["edge", 4, Uint8Array, true]]);
        this.cells = new Int32Array(1024);
        this.darkness = 0; // of edges
    }

    setEdges(darkness, colour) {
        this.darkness = darkness;
        this.mesh.material.uniforms.edgePaint.value.setRGB(...colour);
    }

    /// Edges fade where most facets are too small on the screen for them. `scale` is pixels by length.
    fadeEdges(scale) {
        this.mesh.material.uniforms.edges.value =
            this.darkness * Math.min(1, Math.max(0, (scale * this.size - 3) / 8));
    }

    finish() {
        super.finish();
        this.size = this.meanSize();
    }

    /// Mean length of an edge, of a few hundred facets.
    meanSize() {
        const step = Math.ceil(this.count / 500);
        let sum = 0;
        let edges = 0;
        for (let facet = 0; facet < this.count; facet += step, ++edges) {
            const at = 9 * facet;
            sum += Math.hypot(...[0, 1, 2].map(k => this.position[at + 3 + k] - this.position[at + k]));
        }
        return edges > 0 ? sum / edges : 0;
    }

    /// x: 9 coordinates. drawn[i]: whether the edge opposite to corner i is to be seen.
    push(x, cell, colour, drawn) {
        const facet = this.vertices / 3;
        this.reserve(this.vertices + 3);
        if (facet >= this.cells.length) {
            const cells = new Int32Array(2 * facet);
            cells.set(this.cells);
            this.cells = cells;
        }
        this.cells[facet] = cell;
        this.position.set(x, 9 * facet);
        for (let k = 0, at = 12 * facet; k < 3; ++k, at += 4) {
            for (let c = 0; c < 3; ++c) {
                this.paint[at + c] = colour[c];
                this.edge[at + c] = k === c || !drawn[c] ? 255 : 0;
            }
        }
        this.vertices += 3;
    }

    get count() {
        return this.vertices / 3;
    }
}

/// Segments of a width in pixels, each two triangles with four corners.
class Lines extends GrowingGeometry {
    constructor(width) {
        super(lineMaterial(width), [["position", 3, Float32Array, false], ["other", 3, Float32Array, false],
            ["across", 1, Float32Array, false], ["paint", 4, Uint8Array, true]]);
        this.cells = [];
    }

    clear() {
        super.clear();
        this.cells = [];
    }

    push(from, to, cell, colour) {
        this.reserve(this.vertices + 4);
        this.cells.push(cell);
        this.pushCorner(from, to, 1, colour);
        this.pushCorner(from, to, -1, colour);
        this.pushCorner(to, from, 1, colour);
        this.pushCorner(to, from, -1, colour);
    }

    pushCorner(here, there, across, colour) {
        for (let k = 0; k < 3; ++k) {
            this.position[3 * this.vertices + k] = here[k];
            this.other[3 * this.vertices + k] = there[k];
            this.paint[4 * this.vertices + k] = colour[k];
        }
        this.across[this.vertices] = across;
        this.vertices += 1;
    }

    finish() {
        super.finish();
        const {geometry} = this.mesh;
        if (!geometry.index) { // it has grown
            const index = new Uint32Array(this.capacity / 4 * 6);
            for (let segment = 0; segment < index.length / 6; ++segment) {
                index.set([0, 1, 2, 2, 3, 0].map(k => 4 * segment + k), 6 * segment);
            }
            geometry.setIndex(new THREE.BufferAttribute(index, 1));
        }
        geometry.setDrawRange(0, 6 * this.count);
    }

    get count() {
        return this.vertices / 4;
    }
}

/// What does not change with time, drawn once for each camera and kept as a picture with depths.
class Still {
    constructor() {
        this.scene = new THREE.Scene();
        this.target = new THREE.WebGLRenderTarget(1, 1, {minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter});
        this.target.depthTexture = new THREE.DepthTexture(1, 1, THREE.UnsignedIntType);
        this.outdated = true;
        this.seenFrom = new THREE.Matrix4();
        this.screen = new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), new THREE.ShaderMaterial({
            vertexShader: stillShader.vertex,
            fragmentShader: stillShader.fragment,
            extensions: {fragDepth: true},
            depthFunc: THREE.AlwaysDepth,
            uniforms: {picture: {value: this.target.texture}, depths: {value: this.target.depthTexture}},
        }));
        this.screen.frustumCulled = false;
        this.screen.renderOrder = -1;
    }

    /// Draws the picture anew if it is of another camera, size or paint.
    refresh(renderer, camera, width, height) {
        const [columns, rows] = [width, height].map(size => Math.max(1, Math.round(size * stage.ratio)));
        camera.updateMatrixWorld();
        const seenFrom = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
        if (!this.outdated && this.target.width === columns && this.target.height === rows &&
            seenFrom.equals(this.seenFrom)) {
            return;
        }
        this.outdated = false;
        this.seenFrom = seenFrom;
        this.target.setSize(columns, rows);
        renderer.setRenderTarget(this.target);
        renderer.render(this.scene, camera);
        renderer.setRenderTarget(null);
    }
}

/// A part of the window with a scene, a camera that the user moves, and words at places of the scene.
class Pane {
    constructor(element, camera, controls) {
        this.element = element;
        this.scene = new THREE.Scene();
        this.camera = camera;
        this.controls = controls;
        this.lines = [];
        this.facets = [];
        this.words = [];
        this.moved = false; // by the user
        controls.addEventListener("change", () => stage.ask());
        controls.addEventListener("start", () => {
            this.moved = true;
        });
    }

    addFacets(facets) {
        this.facets.push(facets);
        this.scene.add(facets.mesh);
        return facets;
    }

    addLines(lines) {
        this.lines.push(lines);
        this.scene.add(lines.mesh);
        return lines;
    }

    addWord(text, place, before = false) { // the text ends at the place, else it begins there
        const element = document.createElement("span");
        element.className = before ? "word before" : "word";
        element.textContent = text;
        this.element.append(element);
        this.words.push({element, place});
    }

    placeWords(width, height) {
        for (const {element, place} of this.words) {
            const at = place.clone().project(this.camera);
            element.style.left = `${(at.x + 1) / 2 * width}px`;
            element.style.top = `${(1 - at.y) / 2 * height}px`;
        }
    }

    /// Shows the whole again in another size, unless the user has chosen what to see.
    fitSize(width, height) {
        if (this.width === width && this.height === height) {
            return;
        }
        [this.width, this.height] = [width, height];
        this.resize(width, height);
        if (!this.moved) {
            this.reset();
        }
    }

    draw(renderer, canvas) {
        const {left, top, width, height} = this.element.getBoundingClientRect();
        if (width < 1 || height < 1) {
            return;
        }
        const below = canvas.bottom - top - height;
        this.fitSize(width, height);
        this.facets.forEach(facets => facets.fadeEdges(this.pixelsByLength(height)));
        for (const lines of this.lines) {
            lines.mesh.material.uniforms.size.value.set(width, height);
        }
        this.placeWords(width, height);
        if (this.still) {
            this.still.refresh(renderer, this.camera, width, height);
        }
        renderer.setViewport(left - canvas.left, below, width, height);
        renderer.setScissor(left - canvas.left, below, width, height);
        renderer.render(this.scene, this.camera);
    }
}

/// Whether the browser draws by its processor. Smooth edges then take most of the time.
function isSoftware() {
    const gl = document.createElement("canvas").getContext("webgl");
    const names = gl && gl.getExtension("WEBGL_debug_renderer_info");
    return names !== null && /swiftshader|llvmpipe|software/i.test(gl.getParameter(names.UNMASKED_RENDERER_WEBGL));
}

/// The canvas behind all panes. It is drawn when something has asked for it.
const stage = {
    panes: [],
    asked: false,
    ratio: window.devicePixelRatio, // pixels drawn for each of CSS
    software: isSoftware(),

    start(canvas) {
        this.renderer = new THREE.WebGLRenderer({canvas, antialias: !this.software});
        this.renderer.setScissorTest(true);
        new ResizeObserver(() => this.ask()).observe(canvas.parentElement);
    },

    ask() {
        if (!this.asked) {
            this.asked = true;
            requestAnimationFrame(() => this.draw());
        }
    },

    draw() {
        this.asked = false;
        this.drawAt(window.devicePixelRatio);
        clearTimeout(this.timer);
        if (this.software && this.renderer.info.render.triangles < 200000) {
            this.timer = setTimeout(() => this.drawAt(2 * window.devicePixelRatio), 400); // smooth when all is at rest
        }
    },

    drawAt(ratio) {
        const box = this.renderer.domElement.parentElement.getBoundingClientRect();
        if (this.width !== box.width || this.height !== box.height || this.ratio !== ratio) {
            [this.width, this.height, this.ratio] = [box.width, box.height, ratio];
            this.renderer.setPixelRatio(ratio);
            this.renderer.setSize(box.width, box.height);
        }
        this.renderer.setClearColor(theme.stage);
        this.renderer.setScissor(0, 0, box.width, box.height);
        this.renderer.clear(); // what is between the panes, too
        this.panes.forEach(pane => pane.draw(this.renderer, box));
    },
};
