// The state of the page and what changes it.

const themes = {
    light: {stage: 0xf4f6f8, outer: [178, 187, 196], inside: [236, 224, 194], solid: [216, 224, 232], domain: [222, 232, 241],
        edge: [0.1, 0.13, 0.16], insideEdge: [0.1, 0.13, 0.16], mark: [20, 20, 20], instant: [20, 24, 30]},
    dark: {stage: 0x1b2027, outer: [98, 108, 119], inside: [66, 76, 88], solid: [72, 82, 94], domain: [40, 51, 62],
        edge: [0.03, 0.04, 0.05], insideEdge: [0.62, 0.7, 0.78], mark: [255, 255, 255], instant: [245, 247, 250]},
};
let theme = themes.light;

const state = {
    time: span.first,
    colour: "patch",
    shown: head.patches.map(() => true),
    edges: true,
    cull: true,
    inside: true, // D = 2: the mesh
    clip: {on: false, axis: 1, place: 0.5, flipped: false},
    marked: -1,      // a side cell
    markedAt: null,  // where it was picked
    playing: false,

    /// What is seen is where normal . x <= distance.
    clipPlane() {
        const {axis, place, flipped} = this.clip;
        const sign = flipped ? 1 : -1;
        const at = bounds.least[axis] + place * (bounds.most[axis] - bounds.least[axis]);
        return {normal: new THREE.Vector3().setComponent(axis, sign), distance: sign * at};
    },

    colourOf(cell) {
        return this.colour === "patch" ? patchColour(sidePatch[cell])
            : speedColour(speeds.of[cell], speeds.largest);
    },
};

const views = [];

/// Cuts the boundary at a time and shows it; returns its measures.
function show(time) {
    state.time = Math.min(span.last, Math.max(span.first, time));
    const instant = new Instant(state.time);
    views.forEach(view => view.begin(instant));
    const measures = cutSide(instant, (cell, cut) => {
        if (state.shown[sidePatch[cell]]) {
            const colour = state.colourOf(cell);
            for (const view of views) {
                view.addFacet(cell, cut, colour);
            }
        }
    });
    views.forEach(view => view.addInside(instant));
    views.forEach(view => view.finish());
    panel.tell(instant, measures);
    element("slider").value = state.time;
    if (document.activeElement !== element("time")) {
        element("time").value = shortNumber(state.time);
    }
    stage.ask();
    return measures;
}

/// When colours or what is seen change: of the side in space-time, too.
function repaint() {
    panel.showLegend();
    views.forEach(view => view.paint && view.paint());
    show(state.time);
}

function stepLevel(direction) {
    const next = direction > 0 ? levels.find(level => level > state.time + head.tolerance)
        : levels.filter(level => level < state.time - head.tolerance).pop();
    if (next !== undefined) {
        show(next);
    }
}

// --- Playing

const secondsOfPlay = 8; // from the first time to the last

function play(on) {
    state.playing = on;
    document.body.classList.toggle("playing", on);
    if (on && state.time >= span.last) {
        show(span.first);
    }
    let before = performance.now();
    const frame = now => {
        if (!state.playing) {
            return;
        }
        const next = state.time + (now - before) / 1000 / secondsOfPlay * (span.last - span.first);
        before = now;
        show(next > span.last ? span.first : next);
        requestAnimationFrame(frame);
    };
    if (on) {
        requestAnimationFrame(frame);
    }
}

// --- What the user does

function setColour(colour) {
    state.colour = colour;
    if (colour === "speed") {
        speeds.need();
    }
    repaint();
}

function setTheme(name) {
    theme = themes[name];
    document.documentElement.dataset.theme = name;
    repaint();
}

function setSwitch(id, on) {
    element(id).checked = on;
    if (id === "clip") {
        state.clip.on = on;
        element("clip_tools").classList.toggle("off", !on);
    } else {
        state[id] = on;
    }
    repaint();
}

function setClipAxis(axis) {
    state.clip.axis = axis;
    document.querySelectorAll("[data-axis]").forEach(button =>
        button.setAttribute("aria-pressed", Number(button.dataset.axis) === axis));
    show(state.time);
}

function mark(hit) {
    state.marked = hit ? hit.cell : -1;
    state.markedAt = hit ? hit.place.toArray().slice(0, D).map((x, k) => x + head.centre[k]) : null;
    show(state.time);
}

function togglePanel() {
    document.body.classList.toggle("bare");
    stage.ask();
}

function showAll() {
    for (const pane of stage.panes) {
        pane.moved = false;
        pane.reset();
    }
    stage.ask();
}

function otherTheme() {
    setTheme(theme === themes.dark ? "light" : "dark");
}

const keys = {
    " ": () => play(!state.playing),
    ArrowLeft: event => event.shiftKey ? show(state.time - (span.last - span.first) / 100) : stepLevel(-1),
    ArrowRight: event => event.shiftKey ? show(state.time + (span.last - span.first) / 100) : stepLevel(1),
    Home: () => show(span.first),
    End: () => show(span.last),
    c: () => setColour(state.colour === "patch" ? "speed" : "patch"),
    e: () => setSwitch("edges", !state.edges),
    w: () => setSwitch("cull", !state.cull),
    x: () => D === 3 ? setSwitch("clip", !state.clip.on) : setSwitch("inside", !state.inside),
    r: showAll,
    l: otherTheme,
    m: togglePanel,
    "?": () => element("help").showModal(),
};

function onKey(event) {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const writing = event.target === element("time");
    if (keys[key] && !writing && !event.ctrlKey && !event.metaKey && !event.altKey && !element("help").open) {
        event.preventDefault();
        keys[key](event);
    }
}

function onClick(id, use) {
    element(id).addEventListener("click", use);
}

function listen() {
    addEventListener("keydown", onKey);
    onClick("play", () => play(!state.playing));
    onClick("before", () => stepLevel(-1));
    onClick("after", () => stepLevel(1));
    onClick("by_patch", () => setColour("patch"));
    onClick("by_speed", () => setColour("speed"));
    onClick("theme_button", otherTheme);
    onClick("panel_button", togglePanel);
    onClick("help_button", () => element("help").showModal());
    onClick("flip", () => {
        state.clip.flipped = !state.clip.flipped;
        show(state.time);
    });
    for (const id of ["edges", "cull", "inside", "clip"]) {
        element(id).addEventListener("change", () => setSwitch(id, element(id).checked));
    }
    document.querySelectorAll("[data-axis]").forEach(button =>
        button.addEventListener("click", () => setClipAxis(Number(button.dataset.axis))));
    element("clip_place").addEventListener("input", () => {
        state.clip.place = Number(element("clip_place").value);
        show(state.time);
    });
    element("slider").addEventListener("input", () => {
        play(false);
        show(Number(element("slider").value));
    });
    element("time").addEventListener("change", () => {
        const time = Number(element("time").value);
        show(Number.isFinite(time) ? time : state.time);
        element("time").value = shortNumber(state.time);
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", event =>
        setTheme(event.matches ? "dark" : "light"));
}

function startTransport() {
    const slider = element("slider");
    [slider.min, slider.max, slider.value] = [span.first, span.last, span.first];
    const inner = head.slabs.slice(1).map(slab => slab.first);
    element("ticks").replaceChildren(...(inner.length > 200 ? [] : inner).map(time => {
        const tick = document.createElement("i");
        tick.style.left = `${100 * (time - span.first) / (span.last - span.first)}%`;
        return tick;
    }));
}

function startViews() {
    stage.start(element("canvas"));
    element("space_time_pane").hidden = D === 3;
    views.push(D === 3 ? new SolidView(element("space_pane")) : new PlaneView(element("space_pane")));
    if (D === 2) {
        views.push(new SpaceTimeView(element("space_time_pane")));
    }
    for (const view of views) {
        stage.panes.push(view.pane);
        onTap(view.pane.element, (x, y) => mark(view.pick(x, y)));
    }
}

function fail(problem) {
    const box = withText("p", `This page cannot draw here: ${problem.message}`);
    box.id = "failure";
    element("stage").append(box);
}

/// For scripts that look at the page: see docs/view.md.
window.slabhull = {
    head,
    setTime: show,
    inside: () => measureInside(new Instant(state.time)),
    set: setSwitch,
    setColour,
    setTheme,
    pick: (view, x, y) => {
        const hit = views[view].pick(x, y);
        mark(hit);
        return hit && {patch: head.patches[sidePatch[hit.cell]].name, place: state.markedAt};
    },
    /// Draws now, and waits until it is done.
    draw() {
        stage.draw();
        const gl = stage.renderer.getContext();
        gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    },
};

panel.start();
startTransport();
element("clip_tools").classList.add("off");
if (matchMedia("(max-width: 760px)").matches) {
    document.body.classList.add("bare");
}
try {
    startViews();
    listen();
    setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
} catch (problem) {
    fail(problem);
    throw problem;
}
