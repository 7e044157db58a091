// The panel beside the picture: legends, measures, the cell that was picked, the histogram.

const element = id => document.getElementById(id);

function shortNumber(x) {
    const size = Math.abs(x);
    return size !== 0 && (size < 1e-3 || size >= 1e6) ? x.toExponential(3) : String(Number(x.toPrecision(6)));
}

function withText(tag, text) {
    const made = document.createElement(tag);
    made.textContent = text;
    return made;
}

function fillTable(table, rows) {
    table.replaceChildren(...rows.map(cells => {
        const row = document.createElement("tr");
        row.append(withText("th", cells[0]), ...cells.slice(1).map(cell => withText("td", cell)));
        return row;
    }));
}

const panel = {
    start() {
        const dimension = `${D}D + t`;
        const slabs = head.slabs.length === 1 ? "" : `, ${head.slabs.length} slabs`;
        document.title = `${head.title} – Slabhull`;
        element("title").textContent = head.title;
        element("summary").textContent = `${head.filled ? "filling" : "hull"} in ${dimension}${slabs}, ` +
            `t = ${shortNumber(span.first)} to ${shortNumber(span.last)}, ${side.count.toLocaleString("en")} side cells`;
        this.listPatches();
        this.drawHistogram();
        this.listNotes();
        element("clip_section").hidden = D === 2;
        element("inside_section").hidden = D === 3;
    },

    listPatches() {
        element("patches").replaceChildren(...head.patches.map((patch, k) => {
            const label = document.createElement("label");
            const box = document.createElement("input");
            box.type = "checkbox";
            box.checked = true;
            box.addEventListener("change", () => {
                state.shown[k] = box.checked;
                repaint();
            });
            label.append(box, document.createElement("i"), withText("span", patch.name));
            label.title = `patch ${patch.number}`;
            const item = document.createElement("li");
            item.append(label);
            return item;
        }));
    },

    showLegend() {
        const bySpeed = state.colour === "speed";
        element("by_patch").setAttribute("aria-pressed", !bySpeed);
        element("by_speed").setAttribute("aria-pressed", bySpeed);
        element("speed_legend").hidden = !bySpeed;
        document.querySelectorAll("#patches i").forEach((swatch, k) => {
            swatch.hidden = bySpeed;
            swatch.style.background = cssColour(patchColour(k));
        });
        if (bySpeed) {
            const largest = speeds.need().largest;
            element("speed_least").textContent = shortNumber(-largest);
            element("speed_most").textContent = "+" + shortNumber(largest);
            const pen = element("speed_bar").getContext("2d");
            for (let x = 0; x < 256; ++x) {
                pen.fillStyle = cssColour(speedColour(x / 127.5 - 1, 1));
                pen.fillRect(x, 0, 1, 1);
            }
        }
    },

    drawHistogram() {
        const most = Math.max(...head.angles, 1);
        const width = 250 / head.angles.length;
        const bars = head.angles.map((count, k) => {
            const height = 60 * count / most;
            return `<rect x="${k * width + .5}" y="${64 - height}" width="${width - 1}" height="${height}">` +
                `<title>${10 * k}–${10 * k + 10}°: ${count.toLocaleString("en")}</title></rect>`;
        });
        const marks = [0, 60, 120, 180].map(angle => {
            const anchor = angle === 0 ? "start" : angle === 180 ? "end" : "middle";
            return `<text x="${angle / 180 * 250}" y="77" text-anchor="${anchor}">${angle}°</text>`;
        });
        element("histogram").innerHTML = `<svg viewBox="0 0 250 80" role="img">${bars.join("")}${marks.join("")}</svg>`;
        element("histogram").append(this.note(head.filled && D === 3
            ? "Smallest dihedral angle of each pentatope in space-time"
            : `${D === 3 || head.filled ? "Dihedral angles" : "Angles"} of all cells in space-time`));
    },

    note(text) {
        const note = withText("p", text);
        note.className = "note";
        return note;
    },

    listNotes() {
        element("notes_section").hidden = head.notes.length === 0;
        element("notes").replaceChildren(...head.notes.map(note => withText("li", note)));
    },

    /// What is true at the instant.
    tell(instant, measures) {
        const rows = [["slab", head.slabs[instant.slab].name], [D === 3 ? "triangles" : "edges",
            measures.facets.toLocaleString("en")], [D === 3 ? "area" : "length", shortNumber(measures.measure)]];
        rows.push([D === 3 ? "encloses" : "encloses", shortNumber(measures.enclosed)]);
        head.patches.forEach((patch, k) => rows.push([patch.name, shortNumber(measures.patches[k])]));
        fillTable(element("measures"), rows.slice(0, 16));
        element("space_caption").textContent = `t = ${shortNumber(instant.time)}`;
        this.tellInside(instant);
        this.tellPicked(instant);
    },

    tellInside(instant) {
        const wanted = D === 3 ? state.clip.on : state.inside;
        element("inside_note").hidden = !wanted || knowsInside(instant);
        element("inside_note").textContent = inside.count === 0 ? "The mesh inside is not in this page."
            : "A hull has a mesh inside at its caps only: " + this.capTimes() + ".";
    },

    capTimes() {
        const ends = [...new Set(head.slabs.flatMap(slab => [slab.first, slab.last]))];
        return ends.length > 4 ? `t = ${shortNumber(ends[0])}, ${shortNumber(ends[1])} …`
            : "t = " + ends.map(shortNumber).join(", ");
    },

    tellPicked() {
        const cell = state.marked;
        element("picked_name").textContent = cell < 0 ? "click or tap one" : head.patches[sidePatch[cell]].name;
        element("picked").replaceChildren();
        if (cell < 0) {
            return;
        }
        const table = document.createElement("table");
        const rows = [["vertex id", "track", "t"]];
        for (let i = 0; i <= D; ++i) {
            const vertex = side.vertices[cell * (D + 1) + i];
            rows.push([String(ids[vertex]), tracks[vertex] < 0 ? "–" : String(tracks[vertex]),
                shortNumber(times[timeOfVertex[vertex]])]);
        }
        fillTable(table, rows);
        element("picked").append(table, this.note(`patch ${head.patches[sidePatch[cell]].number}, normal speed ` +
            `${shortNumber(normalSpeed(cell))}` + (state.markedAt ? `, at (${state.markedAt.map(shortNumber).join(", ")})`
                : "")));
    },
};
