// Special points over the step, the mesh and the compliance: their distance from the limit with intervals and the
// fitted order.
{
  const {Interval, methodColours} = ricochet, axes = {
    steps_per_period: ["step", "of a period"],
    elements: ["1 / elements", "1"],
    modes: ["1 / modes", "1"],
    "contact.stiffness": ["1 / stiffness", "m/N"]
  };
  const mostCharts = 12, roundOff = 1e-12, colourOf = (k) => methodColours[k % methodColours.length];

  class PointFigure {
    constructor(data) {
      this.data = data;
      this.branches = new ricochet.Branches(data);
      this.levels = data.rows("point_levels");
      this.lines = data.rows("point_lines");
      this.methods = ricochet.distinct(this.levels.map((row) => row.method));
    }
    // Orders first, then other refinements of the same points, changes of contact last.
    rank([{name, refined}]) {
      const change = /contact at/.test(name) && !/first/.test(name),
            own = this.lines.filter((one) => one.name === name);
      return (change ? 3 : 0) + (own.some((one) => one.refined === refined) ? 0 : own.length ? 1 : 2);
    }
    methodName(id) {
      const one = this.data.byId.get(id);
      return one ? this.branches.methodLabel(one) : id;
    }
    figure() {
      // Charts that show something, at most so many: two distances of a method, or one and a case that lacks the point.
      // What round-off explains is none.
      for (const row of this.levels)
        if (row.distance !== null && row.distance <= roundOff * Math.abs(row.value)) row.distance = 0;
      const far = (rows) => rows.filter((row) => row.distance > 0).length,
            most = (rows) => Math.max(...Array.from(ricochet.groupBy(rows, (row) => [row.method]).values(), far)),
            shows = (rows) => most(rows) > 1 || (most(rows) > 0 && rows.some((row) => row.presence === "absent"));
      const all = Array.from(ricochet.groupBy(this.levels, (row) => [row.name, row.refined]).values())
                      .filter(shows)
                      .sort((a, b) => this.rank(a) - this.rank(b)),
            groups = all.slice(0, mostCharts),
            several = ricochet.distinct(groups.map(([first]) => first.refined)).length > 1;
      const charts = groups.map((rows) => this.chart(rows, several)).filter(Boolean);
      if (!charts.length) return null;
      return {
        id: "points",
        title: "Special points as the step and the mesh are refined",
        views: ["distance"],
        charts,
        legend:
            this.methods.map((id, k) => ({name: this.methodName(id), colour: colourOf(k), dash: "", symbol: "circle"})),
        caption:
            "Distance of a point from the limit of its own method, with its interval; the pale line is the fitted " +
            "order, its number at the end. ○ in the grey strip: the case went past the place without the point." +
            (all.length > mostCharts ? " " + mostCharts + " of " + all.length + " charts are drawn." : ""),
      };
    }
    chart(rows, several) {
      const [{name, refined}] = rows, x = axes[refined] || [refined, "1"],
                    y = ["distance from the limit", this.branches.parameter[1]];
      const shown = rows.filter((row) => row.distance > 0), xs = new Interval().include(...rows.map((row) => row.size)),
            ys = new Interval().include(...shown.flatMap((row) => [row.distance, row.distance + row.half]));
      if (xs.empty) return null;
      if (ys.empty) ys.include(1e-9, 1e-6);
      const up = ricochet.logAxis(y, ys), out = ricochet.view(x, y, ricochet.logAxis(x, xs), up), absent = [];
      const without = rows.filter((row) => row.distance === 0);
      for (const [k, method] of this.methods.entries()) {
        const own = {name: this.methodName(method), colour: colourOf(k), style: 0};
        const line = this.lines.find((one) => one.name === name && one.refined === refined && one.method === method);
        if (line)
          ricochet.fitted(
              out,
              [{at: line.from, distance: line.distance_from}, {at: line.to, distance: line.distance_to}].map(
                  (one) => ({...one, text: "order " + ricochet.format.order(line.order)})),
              {x: "at", y: "distance"}, own, line.order);
        const points = shown.filter((row) => row.method === method)
                           .map((row) => ({
                                  case: row.case,
                                  size: row.size,
                                  distance: row.distance,
                                  low: Math.max(row.distance - row.half, up.min),
                                  high: row.distance + row.half,
                                  hollow: row.presence === "many",
                                  text: this.said(row)
                                }))
                           .sort((a, b) => a.size - b.size);
        const bars = points.filter((row) => row.high > row.low);
        if (bars.length)
          ricochet.draw(
              out, ricochet.ends(bars, "low", "high"), {x: "size", y: "end"},
              {...ricochet.line(own.name, own.colour, 1.4), silent: true});
        if (points.length)
          ricochet.draw(out, points, {x: "size", y: "distance"}, ricochet.hollowCurve(own, points, 7, 1.2));
        absent.push([
          own,
          rows.filter((row) => row.method === method && row.presence === "absent")
              .map(
                  (row) =>
                      ({case: row.case, at: row.size, mark: "○", text: "no such point: a branch went past its place"}))
        ]);
      }
      ricochet.outcomeStrip(out, absent, "absent");
      if (without.length)
        out.notes.push(
            ricochet.format.count(without.length, "point is", "points are") +
            " taken as the limit, since no order is told: at no distance.");
      return {
        title: name + (several ? " · over the " + x[0] : ""),
        cases: rows.map((row) => this.data.byId.get(row.case)).filter(Boolean),
        views: [out],
        notes: []
      };
    }
    said(row) {
      const {text, unit} = ricochet.format, u = unit(this.branches.parameter);
      return text(row.value, 9) + u + ", " + text(row.distance, 3) + u + " from the limit, ± " + text(row.half, 2) +
          (row.presence === "many" ? "; other turns share its place" : "");
    }
  }

  ricochet.figure("points", (data) => {
    if (!data.page.branches || !data.rows("point_levels").length) return [];
    const figure = new PointFigure(data).figure();
    return figure ? [figure] : [];
  });
}
