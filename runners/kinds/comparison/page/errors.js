// Errors against the step and against the number of elements, log–log, one view per kind of error, one curve per method: the fitted slope over the points
// that follow it, the error floor, points at or below it in grey, cases without an error as marks along the upper edge.
{
  const { numberOf, Interval, errors } = ricochet;
  const markHeight = 0.085;   // of the frame
  const follows = 2;          // factor within which a point follows the fitted line

  // All cases; for elements, those at the smallest step of their method.
  function casesFor(view, refined) {
    if (refined === "step") return view.all;
    const step = (one) => { const value = numberOf(one, "step"); return value === null ? Infinity : value; };
    return view.group(view.all, view.varyingWithout(["step", "elements"])).flatMap((group) => {
      const smallest = Math.min(...group.cases.map(step));
      return group.cases.filter((one) => step(one) === smallest);
    });
  }

  class ErrorFigure {
    constructor(data, refined) {
      const view = data.view, byStep = refined === "step";
      Object.assign(this, { data, view, refined, x: byStep ? ["step h", "s"] : ["elements", "1"], xRange: new Interval() });
      this.error = data.finder("errors", ["error"]);
      this.order = data.finder("orders", ["refined", "error"], [refined]);
      this.line = data.finder("order_lines", ["refined", "error"], [refined]);
      this.curves = new ricochet.MethodCurves(view, casesFor(view, refined), refined, [], byStep ? [] : ["step"]);
      this.facets = this.curves.facets;
      const shown = this.facets.flatMap((facet) => facet.cases);
      this.xRange.include(...shown.map((one) => numberOf(one, refined)).filter((value) => value !== null));
      const most = Math.max(0, ...this.facets.map((facet) => {
        const at = new Map();
        for (const one of facet.cases) if (one.status !== "done") at.set(this.place(one), (at.get(this.place(one)) || 0) + 1);
        return Math.max(0, ...at.values());
      }));
      this.gutter = most > 0 ? Math.min(0.5, 0.05 + markHeight * most) : 0;   // share of the frame's height that marks take
    }
    place(one) { const value = numberOf(one, this.refined); return value === null ? this.xRange.low : value; }
    point(one, error) {
      const row = this.error(one, [error]), x = numberOf(one, this.refined);
      return row && x !== null && row.value !== null ? { x, error: row.value, floor: row.floor || 0 } : null;
    }

    figure() {
      const { curves } = this, byStep = this.refined === "step";
      const charts = this.facets.map((facet) => ({ title: facet.title, views: [], notes: this.view.outcomeNotes(facet.cases, curves.said) })), views = [];
      for (const error of errors.kinds(this.data.rows("errors"))) {
        const range = this.range(error);
        if (range.empty) continue;
        views.push(error);
        this.facets.forEach((facet, f) => charts[f].views.push(this.chart(error, facet, range)));
      }
      if (!views.length) return null;
      const floors = charts.some((chart) => chart.views.some((view) => view.option.series.some((one) => one.name === errors.floorName)));
      const caption = curves.colours() + " The pale band under a curve is its fitted order, drawn over the points that stay within a factor of " + follows +
        " of it; the number at its end is the order. Grey points are at or below the error floor, which is how far apart two references are." + (byStep ? "" : " Each method at its smallest step.");
      return {
        id: "error-" + this.refined, title: byStep ? "Errors against the step" : "Errors against the number of elements", caption, views, charts,
        legend: curves.legend().concat(floors ? [{ name: errors.floorName, colour: errors.floorColour, dash: ricochet.svgDash(2), symbol: "" }] : []),
      };
    }
    range(error) {
      const out = new Interval(), floors = new Interval();
      for (const one of this.facets.flatMap((facet) => facet.cases)) {
        const p = this.point(one, error);
        if (p && p.error > 0) out.include(p.error);
        if (p && p.floor > 0) floors.include(p.floor);
      }
      // A floor far below everything stays out of sight.
      if (!out.empty && !floors.empty && floors.high >= 1e-2 * out.low) out.include(Math.min(floors.high, out.high));
      return out;
    }

    chart(error, facet, range) {
      const quantity = errors.quantity(error), y = ricochet.logAxis(quantity, range, true), lowest = y.min;
      y.max = y.max * Math.pow(y.max / y.min, this.gutter / (1 - this.gutter));
      const out = ricochet.view(this.x, quantity, ricochet.logAxis(this.x, this.xRange, false), [y, ricochet.gutterAxis()]), { series } = out.option;
      out.option.grid.right = 46;
      const floorAt = new Map(), stacked = new Map(), zeros = [];
      let without = 0;
      for (const curve of facet.curves) {
        const order = curve.cases.map((one) => this.order(one, [this.refined, error])).find(Boolean), line = curve.cases.map((one) => this.line(one, [this.refined, error])).find(Boolean);
        const said = orderText(order), items = [], marks = [];
        for (const one of curve.cases) {
          const at = this.place(one), p = this.point(one, error);
          if (one.status !== "done") {
            const below = stacked.get(at) || 0;
            stacked.set(at, below + 1);
            marks.push({ value: [at, 0.95 - markHeight * below], mark: ricochet.format.mark(one.status), text: one.status + ": " + one.reason });
            continue;
          }
          if (!p) { ++without; continue; }
          if (p.floor > 0) floorAt.set(at, Math.max(floorAt.get(at) || 0, p.floor));
          if (!(p.error > 0)) { zeros.push(curve.name + " at " + ricochet.format.exact(at)); continue; }
          const item = { value: [at, p.error], text: pointText(p, quantity, said) };
          if (p.error <= p.floor) item.itemStyle = { color: errors.grey };
          items.push(item);
        }
        if (line) series.push(slope(curve, line, said));
        series.push(ricochet.curve(curve.name, curve.colour, curve.style, items));
        if (marks.length) series.push(Object.assign(ricochet.marks(curve.name, curve.colour, marks), { yAxisIndex: 1 }));
      }
      const floor = Array.from(floorAt).sort((a, b) => a[0] - b[0]).filter(([, height]) => height >= lowest).map(([at, height]) => ({ value: [at, height], text: ricochet.format.text(height, 3) }));
      if (floor.length) series.push(floorLine(floor));
      else if (floorAt.size) out.notes.push("The error floor is below this frame.");
      if (zeros.length) out.notes.push("Exactly 0, which a logarithmic axis cannot show: " + zeros.join(", ") + ".");
      if (without) out.notes.push(ricochet.format.count(without, "finished case has", "finished cases have") + " no such error: the notes say why.");
      return out;
    }
  }

  function orderText(row) {
    if (!row) return "";
    const { order } = ricochet.format, known = row.order !== null && row.low !== null && row.high !== null;
    return (known ? "order " + order(row.order) + " [" + order(row.low) + ", " + order(row.high) + "], " : "no order, ") + row.verdict;
  }
  function pointText(p, quantity, said) {
    const { text, unit } = ricochet.format;
    return text(p.error, 5) + unit(quantity) + (p.floor > 0 ? (p.error <= p.floor ? ", at or below the floor of " : ", floor ") + text(p.floor, 3) : "") + (said ? "; " + said : "");
  }
  function slope(curve, line, said) {
    return {
      type: "line", name: curve.name, symbol: "none", z: 1, color: curve.colour, lineStyle: { color: ricochet.lighten(curve.colour, 0.72), width: 7, cap: "round" },
      endLabel: { show: true, formatter: ricochet.format.order(line.order), color: curve.colour, fontSize: 11, distance: 8 }, labelLayout: { moveOverlap: "shiftY" },
      data: [{ value: [line.from, line.error_from], text: said }, { value: [line.to, line.error_to], text: said }],
    };
  }
  function floorLine(data) {
    return {
      type: "line", name: errors.floorName, symbol: data.length === 1 ? "rect" : "none", symbolSize: [24, 1.5], z: 1, color: errors.floorColour,
      lineStyle: { color: errors.floorColour, width: 1.2, type: ricochet.dash(2) }, areaStyle: { color: "#000000", opacity: 0.05, origin: "start" }, data,
    };
  }

  ricochet.figure("errors", (data) => {
    if (!data.rows("errors").length) return [];
    return ["step", "elements"].filter((refined) => data.view.varies(refined)).map((refined) => new ErrorFigure(data, refined).figure()).filter(Boolean);
  });
}
