// Colours of patches and speeds. Those of patches are told apart with any colour vision (Okabe and Ito).

const palette = [[0, 114, 178], [213, 94, 0], [0, 158, 115], [204, 121, 167], [230, 159, 0], [86, 180, 233],
    [143, 101, 63], [120, 94, 240]];
const speedColours = [[40, 75, 190], [120, 155, 230], [222, 222, 218], [235, 140, 110], [180, 20, 40]];

/// The patch that reaches farthest in all directions, the outer boundary; -1 where no single one does.
function outerPatch() {
    const boxes = head.patches.map(() => new Float64Array(2 * D).fill(-Infinity));
    for (let cell = 0; cell < side.count; ++cell) {
        const box = boxes[sidePatch[cell]];
        for (let i = 0; i <= D; ++i) {
            const at = D * side.vertices[cell * (D + 1) + i];
            for (let axis = 0; axis < D; ++axis) {
                const x = points[at + axis];
                box[axis] = x > box[axis] ? x : box[axis];
                box[D + axis] = -x > box[D + axis] ? -x : box[D + axis];
            }
        }
    }
    const whole = boxes.reduce((all, box) => all.map((value, k) => Math.max(value, box[k])));
    const outer = boxes.filter(box => box.every((value, k) => value >= whole[k]));
    return {patch: outer.length === 1 && boxes.length > 1 ? boxes.indexOf(outer[0]) : -1, box: whole};
}
const outer = outerPatch();

/// Least and largest coordinates of the side, at all times.
const bounds = {
    least: Array.from({length: 3}, (_, k) => k < D ? -outer.box[D + k] : 0),
    most: Array.from({length: 3}, (_, k) => k < D ? outer.box[k] : 0),
};

/// The outer boundary has the theme's own colour.
function patchColour(k) {
    return k === outer.patch ? theme.outer : palette[(outer.patch >= 0 && k > outer.patch ? k - 1 : k) % palette.length];
}

/// The colour of a speed from -largest to largest.
function speedColour(speed, largest) {
    const at = largest > 0 ? (speed / largest + 1) / 2 * (speedColours.length - 1) : (speedColours.length - 1) / 2;
    const k = Math.min(speedColours.length - 2, Math.max(0, Math.floor(at)));
    return speedColours[k].map((a, c) => a + (at - k) * (speedColours[k + 1][c] - a));
}

function cssColour(colour) {
    return `rgb(${colour.map(Math.round).join(",")})`;
}
