// Work against error, one view per kind of error, one curve per method over its steps. Shown besides: the Pareto front
// of all methods of a scene, the error floor, and a gutter for the cases without an error.
{
  const {Interval, errors} = ricochet;
  const frontColour = "#E8D95A", frontName = "Pareto front";
  const gutterColumns = 4, gutterRows = 11, gutterShare = 0.13;  // of the decades of the axis

  // `work`: id, title, caption, quantity, column of `work_points` on the vertical axis, spread (whether to draw the
  // repeats), front (a column, or none).
  class WorkFigure {
    constructor(data, work) {
      const {view} = data;
      Object.assign(this, {view, work, table: data.rows("work_points")});
      // What makes another scene of it: neither methods, nor mesh, nor step.
      this.scene = view.varyingWithout(["mass", "contact", "friction", "time", "march", "elements", "step"]);
      this.curves = new ricochet.MethodCurves(view, view.all, "step", {apart: this.scene});
      this.scenes = view.group(view.all, this.scene);
      this.found = data.rowsBy("work_points", ["case", "error"]);
    }
    row(one, error) { return this.found(one.id, error)[0]; }
    // Why a case has no such error, "" where it has.
    none(one, error) {
      const row = this.row(one, error);
      return row ? row.none : "no such error";
    }
    // Rows of the table for cases that have such an error, and such work.
    rows(cases, error) {
      return cases.map((one) => this.row(one, error))
          .filter((row) => row && row.none === "" && row[this.work.column] > 0);
    }

    figure() {
      const {work, view, curves} = this, kinds = [];
      for (const error of errors.kinds(this.table)) {
        const rows = this.rows(view.all, error), columns = work.spread ? [work.column, "low", "high"] : [work.column];
        const x = new Interval().include(...rows.map((row) => row.value)),
              y = new Interval().include(...rows.flatMap((row) => columns.map((column) => row[column])));
        if (!x.empty)
          kinds.push(
              {error, x: ricochet.wholeDecades(x), y, gutter: view.all.some((one) => this.none(one, error) !== "")});
      }
      if (!kinds.length) return null;
      const charts = curves.charts((facet) => kinds.map((kind) => this.chart(kind, facet))), legend = curves.legend();
      if (work.front) legend.push({name: frontName, colour: frontColour});
      if (ricochet.drawnNames(charts).has(errors.floorName)) legend.push(errors.floorEntry);
      return {
        id: work.id,
        title: work.title,
        caption: curves.colours() + work.caption,
        views: kinds.map(({error}) => error),
        charts,
        legend,
        measured: {key: "errors", along: "step", values: errors.measured(kinds, (one, error) => this.row(one, error))}
      };
    }

    chart({error, x: xRange, y: yRange, gutter}, facet) {
      const {work} = this, quantity = errors.quantity(error), edge = xRange.high,
            far = gutter ? edge * Math.pow(edge / xRange.low, gutterShare) : edge;
      const x = Object.assign(ricochet.logAxis(quantity, xRange), {max: far}),
            y = ricochet.logAxis(work.quantity, yRange);
      const out = ricochet.view(quantity, work.quantity, x, [y, ricochet.gutterAxis()]);
      if (gutter)
        out.marks.push({
          mark: "cells",
          name: "no error",
          colour: "#f2f2f2",
          said: "no error",
          letters: "#7a7a7a",
          low: true,
          silent: true,
          z: 0,
          rows: [{}],
          x: [edge, null]
        });
      if (work.front) this.drawFront(error, facet, out);
      let drawn = 0;
      for (const curve of facet.curves) {
        const rows = this.rows(curve.cases, error).map((row) => ({...row, text: this.pointText(row)}));
        const bars = work.spread ? ricochet.ends(rows.filter((row) => row.high > row.low), "low", "high") : [];
        if (bars.length)
          ricochet.draw(
              out, bars, {x: "value", y: "end"},
              {...ricochet.line(curve.name, curve.colour, 1), symbol: "bar", size: 9, z: 3});
        const size = (row) => (work.front && row[work.front] ? 12 : 8);
        ricochet.draw(out, rows, {x: "value", y: work.column}, {...errors.curve(curve), size});
        const without = gutter ? curve.cases.filter((one) => !this.rows([one], error).length) : [];
        ricochet.drawMarks(
            out, curve, without.map((one) => this.gutterMark(one, error, drawn++, edge, far)), {apart: true});
      }
      const all = this.rows(facet.cases, error), floor = Math.max(0, ...all.map((row) => row.floor)),
            text = "errors below " + ricochet.format.text(floor, 3) + " are not told apart";
      if (floor >= xRange.low)
        ricochet.draw(out, [y.min, y.max].map((end) => ({floor, end, text})), {x: "floor", y: "end"}, errors.floorLine);
      this.sayWithout(facet, error, out);
      return out;
    }

    // Low left corner of what was reached: its line, and the methods on it, said once below the first chart of their
    // scene.
    drawFront(error, facet, out) {
      const {view, work} = this, scene = this.scenes.find((group) => group.cases.includes(facet.cases[0])).cases;
      const first = this.curves.facets.find((other) => scene.includes(other.cases[0])) === facet,
            columns = view.varyingWithout(["step"]).filter((column) => !this.scene.includes(column));
      const rows = this.rows(scene, error).map((row) => ({
                                                 ...row,
                                                 known: Math.max(row.value, row.floor),
                                                 text: "no case is both faster and more precise"
                                               }));
      const front =
          rows.filter((row) => row[work.front]).sort((a, b) => a.known - b.known || a[work.column] - b[work.column]);
      const names = (some) =>
          ricochet.distinct(some.map((row) => view.label(view.data.byId.get(row.case), columns))).filter(Boolean);
      const on = names(front),
            near = work.spread ? names(rows.filter((row) => row.near_front)).filter((name) => !on.includes(name)) : [];
      if (first && on.length) out.notes.push("On the front: " + on.join("; ") + ".");
      if (first && near.length)
        out.notes.push(
            "Not told from the front, since the spreads of their times overlap it: " + near.join("; ") + ".");
      const style = {
        ...ricochet.line(frontName, frontColour, 9),
        ...(front.length === 1 ? {symbol: "circle", size: 18} : {}),
        cap: "round"
      };
      ricochet.draw(out, front, {x: "known", y: work.column}, style);
    }
    gutterMark(one, error, count, edge, far) {
      const done = one.status === "done", who = this.view.label(one, this.curves.said),
            why = done ? this.none(one, error) : one.status + ": " + one.reason;
      return {
        case: one.id,
        at: far * Math.pow(edge / far, (Math.floor(count / gutterRows) % gutterColumns + 0.5) / gutterColumns),
        height: 0.95 - 0.085 * (count % gutterRows),
        mark: done ? "–" : ricochet.format.mark(one.status),
        text: who ? who + ": " + why : why,
      };
    }
    sayWithout(facet, error, out) {
      const reasons =
          facet.cases.filter((one) => one.status === "done").map((one) => this.none(one, error)).filter(Boolean);
      for (const [why, {length}] of ricochet.groupBy(reasons, (why) => [why]))
        out.notes.push("– " + ricochet.format.count(length, "finished case", "finished cases") + ": " + why);
    }
    pointText(row) {
      const {text, exact} = ricochet.format;
      let out = "step " + exact(ricochet.numberOf(this.view.data.byId.get(row.case), "step") || 0) +
          " s: " + text(row.seconds, 3) + " s";
      if (row.high > row.low) out += " [" + text(row.low, 3) + ", " + text(row.high, 3) + "]";
      if (row.steps > 0) out += ", " + exact(row.steps) + " steps, " + text(row.microseconds, 3) + " µs each";
      if (row.value <= row.floor) out += "; at or below the error floor of " + text(row.floor, 3);
      return out + (this.work.front && row[this.work.front] ? "; on the front" : "");
    }
  }

  const gutter =
      " The grey strip at the right holds the cases without an error: refused ⊘, diverged ✕, failed !, or no such " +
      "error –.";
  ricochet.workAgainstError = (data, work) => {
    if (!data.rows("work_points").length) return [];
    return [new WorkFigure(data, Object.assign({}, work, {caption: work.caption + gutter})).figure()].filter(Boolean);
  };
}
