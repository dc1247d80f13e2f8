// Distances of sections to those of the reference case, as views of one figure each: against every numeric axis of at least three values, and along the
// parameter. The null level, of two halves of one run, lies behind both.
{
  const { Interval, numberOf } = ricochet;
  const nullColour = "#B9C7D6", nullName = "null level";
  const kinds = [{ name: "Wasserstein-1", key: "wasserstein" }, { name: "Hausdorff", key: "hausdorff" }];

  function padded(range) {
    const slack = range.high > range.low ? 0.02 * (range.high - range.low) : Math.max(0.01 * Math.abs(range.low), 1e-12);
    return new Interval(range.low - slack, range.high + slack);
  }
  const quantity = (kind) => [kind.name + " distance", "1"];

  class Distances {
    constructor(data) {
      const spreads = data.rows("distance_spreads");
      Object.assign(this, { data, view: data.view, spreads, medians: data.rows("distance_medians") });
      this.reference = spreads.length ? spreads[0].reference_case : "";
      const known = new Set(spreads.map((row) => row.case));
      this.cases = data.view.all.filter((one) => known.has(one.id) && one.id !== this.reference);
      this.parameters = new Interval().include(...this.medians.map((row) => row.parameter));
    }
    spread(id, kind) { return this.spreads.find((row) => row.case === id && row.kind === kind.key && row.count > 0); }
    // Of all distances of a kind, and of its null level.
    range(kind) {
      const out = new Interval();
      for (const row of this.spreads) if (row.kind === kind.key) out.include(...[row.smallest, row.largest].filter((value) => value !== null));
      return out;
    }
    get empty() { return !this.cases.length || kinds.every((kind) => this.range(kind).empty); }

    figure(id, title, caption, curves, more = "") {
      const reference = this.data.byId.get(this.reference), name = reference ? this.view.label(reference) || "the one method" : this.reference;
      const basis = " Reference: " + name + ". Distances of sections in (displacement, velocity), each divided by its spread over the study. Band: up to the null level, what two halves of one run differ by.";
      return { id, title, caption: caption + basis + more, views: kinds.map((kind) => kind.name), charts: [], legend: curves.legend().concat([{ name: nullName, colour: nullColour, dash: "0 30", symbol: "rect" }]) };
    }

    // The median by case against a numeric axis.
    against(column, values) {
      const curves = new ricochet.MethodCurves(this.view, this.cases.filter((one) => numberOf(one, column) !== null), column);
      const out = this.figure("distance-" + ricochet.slug(column), "Distance to the reference against " + column, "Median over parameter and starts; bars: the middle 80 % of them.", curves, " " + curves.colours());
      out.charts = curves.facets.map((facet) => ({ title: facet.title, notes: [], views: kinds.map((kind) => this.againstView(column, values, facet, kind)) }));
      return out;
    }
    againstView(column, values, facet, kind) {
      const { text, count } = ricochet.format, x = [column, this.view.unit(column)], heights = new Interval(), series = [], none = this.spread("", kind);
      let zeros = 0, shown = 0;
      for (const curve of facet.curves) {
        const items = [], bars = [];
        for (const one of curve.cases) {
          const spread = this.spread(one.id, kind), at = numberOf(one, column) || 0;
          if (!spread) continue;
          ++shown;
          if (!(spread.median > 0)) { ++zeros; items.push({ value: [at, "-"] }); continue; }
          const low = spread.low > 0 ? spread.low : spread.median;
          heights.include(spread.median, low);
          if (spread.high > 0) heights.include(spread.high);
          const said = "median " + text(spread.median) + " over " + count(spread.count, "value", "values") + "; 10 % to 90 %: " + text(spread.low) + " to " + text(spread.high) + "; " + spread.zeros + " are exactly zero";
          items.push({ value: [at, spread.median], text: said });
          bars.push([at, low], [at, spread.high], [at, "-"]);
        }
        series.push(Object.assign(ricochet.curve(curve.name, curve.colour, curve.style, items, 7), { z: 3 }));
        series.push({ type: "line", name: curve.name, symbol: "none", silent: true, z: 2, color: curve.colour, lineStyle: { color: ricochet.lighten(curve.colour, 0.4), width: 1.2 }, data: bars });
      }
      if (none && none.high > 0) heights.include(none.high);
      if (none && none.median > 0) heights.include(0.5 * none.median);
      if (heights.empty) heights.include(0.1, 1);
      const logarithmic = values.low > 0 && values.high >= 9 * values.low, xAxis = logarithmic ? ricochet.logAxis(x, values, false) : ricochet.valueAxis(x, padded(values), false);
      const out = ricochet.view(x, quantity(kind), xAxis, ricochet.logAxis(quantity(kind), heights, true));
      if (none && none.high > 0) out.option.series.push(band(xAxis, ricochet.wholeDecades(heights).low, none.high));
      out.option.series.push(...series);
      if (zeros) out.notes.push("In " + zeros + " of " + shown + " cases the median distance is exactly zero, below this axis.");
      if (none) out.notes.push("Null level: median " + text(none.median) + ", 10 % to 90 %: " + text(none.low) + " to " + text(none.high) + ".");
      return out;
    }

    // The median over the starts at each value of the parameter.
    along() {
      const curves = new ricochet.MethodCurves(this.view, this.cases, "");
      const out = this.figure("distance", "Distance to the reference along the parameter", "Median over the starts at each value of the parameter.", curves);
      out.linked = true;
      out.charts = curves.facets.map((facet) => ({ title: facet.title, notes: [], height: 300, views: kinds.map((kind) => this.alongView(facet, kind)) }));
      return out;
    }
    alongView(facet, kind) {
      const x = this.data.page.orbits ? this.data.page.orbits.parameter : ["parameter", ""], heights = this.range(kind);
      if (heights.empty) heights.include(0.1, 1);
      // What is nearer than a millionth of the farthest is round-off of one and the same orbit.
      heights.low = Math.max(heights.low, 1e-6 * heights.high);
      const floor = ricochet.wholeDecades(heights).low, raised = (row) => [row.parameter, Math.max(row.median, floor)];
      const logarithmic = ricochet.logarithmicSweep(this.parameters), xAxis = logarithmic ? ricochet.logAxis(x, this.parameters, false) : ricochet.valueAxis(x, padded(this.parameters), false);
      const out = ricochet.view(x, quantity(kind), xAxis, ricochet.logAxis(quantity(kind), heights, true)), rows = this.medians.filter((row) => row.kind === kind.key && row.median !== null);
      let below = 0;
      for (const curve of facet.curves) {
        const own = rows.filter((row) => curve.cases.some((one) => one.id === row.case));
        below += own.filter((row) => row.median < floor).length;
        const line = Object.assign(ricochet.curve(curve.name, curve.colour, curve.style, own.map(raised), 4, 1.1), { z: 3 });
        delete line.lineStyle.type;
        out.option.series.push(line);
      }
      const level = rows.filter((row) => row.case === "").map(raised);
      if (level.length)
        out.option.series.push({ type: "line", name: nullName, symbol: "none", silent: true, z: 1, color: nullColour, lineStyle: { width: 0 }, areaStyle: { color: nullColour, opacity: 0.75, origin: "start" }, data: level });
      if (below) out.notes.push(ricochet.format.count(below, "distance lies", "distances lie") + " below the frame and " + (below === 1 ? "is" : "are") + " drawn on its lower edge.");
      return out;
    }
  }

  function band(x, low, high) {
    return {
      type: "line", name: nullName, symbol: "none", silent: true, color: nullColour, z: 1, data: [[x.min, high]],
      markArea: { silent: true, itemStyle: { color: nullColour, opacity: 0.75 }, data: [[{ coord: [x.min, low] }, { coord: [x.max, high] }]] },
    };
  }

  ricochet.figure("distance", (data) => {
    const distances = new Distances(data), out = [];
    if (distances.empty) return out;
    for (const column of data.view.varying) {
      const values = new Set(distances.cases.map((one) => numberOf(one, column)).filter((value) => value !== null));
      if (values.size >= 3) out.push(distances.against(column, new Interval().include(...values)));
    }
    return out.concat([distances.along()]);
  });
}
