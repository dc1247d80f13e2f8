// Work against error, one view per kind of error, one curve per method over its steps: the Pareto front of all methods of a scene, the error floor, and
// a gutter for the cases without an error.
{
  const { Interval, errors } = ricochet;
  const frontColour = "#E8D95A", frontName = "Pareto front";
  const slots = 40;   // of the hidden axis that places marks in the gutter
  const gutterColumns = 4, gutterRows = 11, gutterShare = 0.13;   // of the decades of the axis

  // `work`: id, title, caption, quantity, column of `work_points` on the vertical axis, spread (whether to draw the repeats), front (a column, or none).
  class WorkFigure {
    constructor(data, work) {
      const view = data.view, rows = data.rows("work_points");
      Object.assign(this, { data, view, work, rows });
      // What makes another scene of it: neither methods, nor mesh, nor step.
      this.scene = view.varyingWithout(["mass", "contact", "time", "elements", "step"]);
      this.curves = new ricochet.MethodCurves(view, view.all, "step", this.scene);
      this.points = new Map(rows.map((row) => [row.case + "\u001f" + row.error, row]));
      this.scenes = view.group(view.all, this.scene);
    }
    row(one, error) { return this.points.get(one.id + "\u001f" + error); }
    // null where the case has no such error, or no such work.
    point(one, error) {
      const row = this.row(one, error);
      return row && row.none === "" && row[this.work.column] > 0 ? row : null;
    }

    figure() {
      const { work, view, curves } = this, charts = curves.facets.map((facet) => ({ title: facet.title, views: [], notes: view.outcomeNotes(facet.cases, curves.said) })), views = [];
      for (const error of errors.kinds(this.rows)) {
        const x = new Interval(), y = new Interval();
        for (const one of view.all) {
          const p = this.point(one, error);
          if (!p) continue;
          x.include(p.value);
          y.include(p[work.column]);
          if (work.spread) y.include(p.low, p.high);
        }
        if (x.empty) continue;
        const gutter = view.all.some((one) => !(this.row(one, error) && this.row(one, error).none === ""));
        views.push(error);
        curves.facets.forEach((facet, f) => charts[f].views.push(this.chart(error, facet, ricochet.wholeDecades(x), y, gutter)));
      }
      if (!views.length) return null;
      const floors = charts.some((chart) => chart.views.some((one) => one.option.series.some((series) => series.name === errors.floorName)));
      const legend = curves.legend();
      if (work.front) legend.push({ name: frontName, colour: frontColour, dash: "", symbol: "" });
      if (floors) legend.push({ name: errors.floorName, colour: errors.floorColour, dash: ricochet.svgDash(2), symbol: "" });
      return { id: work.id, title: work.title, caption: curves.colours() + work.caption, views, charts, legend };
    }

    chart(error, facet, xRange, yRange, gutter) {
      const { work } = this, quantity = errors.quantity(error), edge = xRange.high, far = gutter ? edge * Math.pow(edge / xRange.low, gutterShare) : edge;
      const x = Object.assign(ricochet.logAxis(quantity, xRange, false), { max: far }), y = ricochet.logAxis(work.quantity, yRange, true);
      // Marks of cases without an error have no place along x: a hidden axis of slots puts them into the gutter.
      const names = Array.from({ length: slots }, (_, k) => "slot " + k);
      const out = ricochet.view(quantity, work.quantity, [x, { type: "category", data: names, show: false }], [y, ricochet.gutterAxis()]), { series } = out.option;
      if (work.front) this.drawFront(error, facet, out);
      let drawn = 0, floor = 0;
      const lines = [];
      for (const curve of facet.curves) {
        const items = [], bars = [], marks = [];
        for (const one of curve.cases) {
          const p = this.point(one, error);
          if (!p) { if (gutter) marks.push(this.gutterMark(one, error, drawn++)); continue; }
          floor = Math.max(floor, p.floor);
          const front = Boolean(work.front && p[work.front]), item = { value: [p.value, p[work.column]], text: this.pointText(one, p, front) };
          if (p.value <= p.floor) item.itemStyle = { color: errors.grey };
          if (front) item.symbolSize = 12;
          items.push(item);
          if (work.spread && p.high > p.low) bars.push({ value: [p.value, p.low], text: item.text }, { value: [p.value, p.high], text: item.text }, { value: ["-", "-"] });
        }
        if (bars.length) series.push({ type: "line", name: curve.name, symbol: "rect", symbolSize: [9, 1.2], color: curve.colour, lineStyle: { color: curve.colour, width: 1, type: "solid" }, data: bars });
        lines.push(ricochet.curve(curve.name, curve.colour, curve.style, items));
        series.push(lines[lines.length - 1]);
        if (marks.length) series.push(Object.assign(ricochet.marks(curve.name, curve.colour, marks), { xAxisIndex: 1, yAxisIndex: 1 }));
      }
      if (floor >= xRange.low) series.push(floorLine(floor, y));
      if (gutter && lines.length) lines[0].markArea = gutterArea(edge, far);
      this.sayWithout(facet, error, out);
      return out;
    }

    // Low left corner of what was reached: its line, and the methods on it, said once below the first chart of their scene.
    drawFront(error, facet, out) {
      const { view, work } = this, scene = this.scenes.find((group) => group.cases.includes(facet.cases[0])).cases;
      const first = this.curves.facets.find((other) => scene.includes(other.cases[0])) === facet;
      const columns = view.varyingWithout(["step"]).filter((column) => !this.scene.includes(column)), names = (cases) => ricochet.distinct(cases.map((one) => view.label(one, columns))).filter(Boolean);
      const known = (p) => Math.max(p.value, p.floor), front = scene.filter((one) => { const p = this.point(one, error); return p && p[work.front]; });
      front.sort((a, b) => known(this.point(a, error)) - known(this.point(b, error)) || this.point(a, error)[work.column] - this.point(b, error)[work.column]);
      const on = names(front), near = work.spread ? names(scene.filter((one) => { const p = this.point(one, error); return p && p.near_front; })).filter((name) => !on.includes(name)) : [];
      if (first && on.length) out.notes.push("On the front: " + on.join("; ") + ".");
      if (first && near.length) out.notes.push("Not told from the front, since the spreads of their times overlap it: " + near.join("; ") + ".");
      const data = front.map((one) => this.point(one, error)).map((p) => ({ value: [known(p), p[work.column]], text: "no case is both faster and more precise" }));
      out.option.series.push({ type: "line", name: frontName, symbol: data.length === 1 ? "circle" : "none", symbolSize: 18, z: 1, color: frontColour, lineStyle: { color: frontColour, width: 9, cap: "round" }, data });
    }
    gutterMark(one, error, count) {
      const row = this.row(one, error), done = one.status === "done", column = slots - 1 - Math.floor(count / gutterRows) % gutterColumns;
      const who = this.view.label(one, this.curves.said), why = done ? (row ? row.none : "no such error") : one.status + ": " + one.reason;
      return { value: ["slot " + column, 0.95 - 0.085 * (count % gutterRows)], mark: done ? "–" : ricochet.format.mark(one.status), text: who ? who + ": " + why : why };
    }
    sayWithout(facet, error, out) {
      const counts = new Map();
      for (const one of facet.cases) {
        const row = this.row(one, error), why = row ? row.none : "no such error";
        if (one.status === "done" && why) counts.set(why, (counts.get(why) || 0) + 1);
      }
      for (const [why, count] of counts) out.notes.push("– " + ricochet.format.count(count, "finished case", "finished cases") + ": " + why);
    }
    pointText(one, p, front) {
      const { text, exact } = ricochet.format;
      let out = "step " + exact(ricochet.numberOf(one, "step") || 0) + " s: " + text(p.seconds, 3) + " s";
      if (p.high > p.low) out += " [" + text(p.low, 3) + ", " + text(p.high, 3) + "]";
      if (p.steps > 0) out += ", " + exact(p.steps) + " steps, " + text(p.microseconds, 3) + " µs each";
      if (p.value <= p.floor) out += "; at or below the error floor of " + text(p.floor, 3);
      return out + (front ? "; on the front" : "");
    }
  }

  function floorLine(floor, y) {
    const text = "errors below " + ricochet.format.text(floor, 3) + " are not told apart";
    return {
      type: "line", name: errors.floorName, symbol: "none", z: 1, color: errors.floorColour, lineStyle: { color: errors.floorColour, width: 1.2, type: ricochet.dash(2) },
      data: [y.min, y.max].map((end) => ({ value: [floor, end], text })),
    };
  }
  const gutterArea = (from, to) => ({
    silent: true, itemStyle: { color: "#000000", opacity: 0.05 }, label: { show: true, position: "insideBottom", color: "#7a7a7a", fontSize: 10 },
    data: [[{ name: "no error", xAxis: from }, { xAxis: to }]],
  });

  const gutter = " The grey strip at the right holds the cases without an error: refused ⊘, diverged ✕, failed !, or no such error –.";
  ricochet.workAgainstError = (data, work) => {
    if (!data.rows("work_points").length) return [];
    return [new WorkFigure(data, Object.assign({}, work, { caption: work.caption + gutter })).figure()].filter(Boolean);
  };
}
