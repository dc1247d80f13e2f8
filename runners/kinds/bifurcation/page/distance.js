// Distances of sections to those of the reference case, as views of one figure each. The axes are every numeric axis of
// at least three values, and the parameter. The null level, of two halves of one run, lies behind both.
{
  const {Interval, numberOf} = ricochet;
  const nullColour = "#B9C7D6", nullName = "null level";
  const kinds = [{name: "Wasserstein-1", key: "wasserstein"}, {name: "Hausdorff", key: "hausdorff"}];

  function padded(range) {
    const slack =
        range.high > range.low ? 0.02 * (range.high - range.low) : Math.max(0.01 * Math.abs(range.low), 1e-12);
    return new Interval(range.low - slack, range.high + slack);
  }
  const quantity = (kind) => [kind.name + " distance", "1"];

  class Distances {
    constructor(data) {
      const spreads = data.rows("distance_spreads");
      Object.assign(this, {
        data,
        view: data.view,
        spreads,
        spreadOf: data.rowsBy("distance_spreads", ["case", "kind"]),
        medians: data.rows("distance_medians")
      });
      this.reference = spreads.length ? spreads[0].reference_case : "";
      const known = new Set(spreads.map((row) => row.case));
      this.cases = data.view.all.filter((one) => known.has(one.id) && one.id !== this.reference);
      this.parameters = new Interval().include(...this.medians.map((row) => row.parameter));
    }
    spread(id, kind) { return this.spreadOf(id, kind.key).find((row) => row.count > 0); }
    // Of all distances of a kind, and of its null level.
    range(kind) {
      return new Interval().include(
          ...this.spreads.filter((row) => row.kind === kind.key).flatMap((row) => [row.smallest, row.largest]));
    }
    get empty() { return !this.cases.length || kinds.every((kind) => this.range(kind).empty); }

    figure(id, title, caption, curves, more = "") {
      const reference = this.data.byId.get(this.reference),
            name = reference ? this.view.label(reference) || "the one method" : this.reference;
      const basis = " Reference: " + name +
          ". Distances of sections in (displacement, velocity), each divided by its spread over the study. Band: up " +
          "to the null level, what two halves of one run differ by.";
      return {
        id,
        title,
        caption: caption + basis + more,
        views: kinds.map((kind) => kind.name),
        charts: [],
        legend: curves.legend().concat([ricochet.swatch(nullName, nullColour)])
      };
    }

    // The median by case against a numeric axis.
    against(column, values) {
      const curves =
          new ricochet.MethodCurves(this.view, this.cases.filter((one) => numberOf(one, column) !== null), column);
      const out = this.figure(
          "distance-" + ricochet.slug(column), "Distance to the reference against " + column,
          "Median over parameter and starts; bars: the middle 80 % of them.", curves, " " + curves.colours());
      out.charts = curves.facets.map((facet) => ({
                                       title: facet.title,
                                       cases: facet.cases,
                                       notes: [],
                                       views: kinds.map((kind) => this.againstView(column, values, facet, kind))
                                     }));
      return out;
    }
    againstView(column, values, facet, kind) {
      const {text} = ricochet.format, x = [column, this.view.unit(column)], none = this.spread("", kind);
      const curves = facet.curves.map(
          (curve) => ({
            curve,
            rows: curve.cases.map((one) => ({at: numberOf(one, column) || 0, ...this.spread(one.id, kind)}))
                      .filter((row) => row.count > 0)
          }));
      const all = curves.flatMap(({rows}) => rows), drawn = all.filter((row) => row.median > 0),
            low = (row) => (row.low > 0 ? row.low : row.median);
      const heights = new Interval().include(
          ...drawn.flatMap((row) => [row.median, low(row)].concat(row.high > 0 ? [row.high] : [])));
      if (none && none.high > 0) heights.include(none.high);
      if (none && none.median > 0) heights.include(0.5 * none.median);
      if (heights.empty) heights.include(0.1, 1);
      const logarithmic = ricochet.logarithmicAxis(values),
            xAxis = ricochet.axisOf(logarithmic, x, logarithmic ? values : padded(values));
      const out = ricochet.view(x, quantity(kind), xAxis, ricochet.logAxis(quantity(kind), heights));
      if (none && none.high > 0) band(out, none.high);
      for (const {curve, rows} of curves) {
        const points =
                  rows.map((row) => ({at: row.at, median: row.median > 0 ? row.median : null, text: spreadText(row)})),
              spreads = rows.filter((row) => row.median > 0).map((row) => ({...row, low: low(row)}));
        ricochet.draw(out, points, {x: "at", y: "median"}, {...ricochet.curve(curve, 7), z: 3});
        ricochet.draw(
            out, ricochet.ends(spreads, "low", "high"), {x: "at", y: "end"},
            {...ricochet.line(curve.name, ricochet.lighten(curve.colour, 0.4), 1.2), silent: true, z: 2});
      }
      if (drawn.length < all.length)
        out.notes.push(
            "In " + (all.length - drawn.length) + " of " + all.length +
            " cases the median distance is exactly zero, below this axis.");
      if (none)
        out.notes.push(
            "Null level: median " + text(none.median) + ", 10 % to 90 %: " + text(none.low) + " to " + text(none.high) +
            ".");
      return out;
    }

    // The median over the starts at each value of the parameter.
    along() {
      const curves = new ricochet.MethodCurves(this.view, this.cases, "");
      const out = this.figure(
          "distance", "Distance to the reference along the parameter",
          "Median over the starts at each value of the parameter.", curves);
      out.charts = curves.facets.map((facet) => ({
                                       title: facet.title,
                                       cases: facet.cases,
                                       notes: [],
                                       height: 300,
                                       views: kinds.map((kind) => this.alongView(facet, kind))
                                     }));
      return {...out, linked: true};
    }
    alongView(facet, kind) {
      const x = this.data.page.orbits ? this.data.page.orbits.parameter : ["parameter", ""], heights = this.range(kind);
      if (heights.empty) heights.include(0.1, 1);
      // What is nearer than a millionth of the farthest is round-off of one and the same orbit.
      heights.low = Math.max(heights.low, 1e-6 * heights.high);
      const floor = ricochet.wholeDecades(heights).low, logarithmic = ricochet.logarithmicSweep(this.parameters);
      const xAxis = ricochet.axisOf(logarithmic, x, logarithmic ? this.parameters : padded(this.parameters)),
            out = ricochet.view(x, quantity(kind), xAxis, ricochet.logAxis(quantity(kind), heights));
      const medians = this.medians.filter((row) => row.kind === kind.key && row.median !== null)
                          .map((row) => ({...row, drawn: Math.max(row.median, floor)})),
            encode = {x: "parameter", y: "drawn"};
      let below = 0;
      for (const curve of facet.curves) {
        const own = medians.filter((row) => curve.cases.some((one) => one.id === row.case));
        below += own.filter((row) => row.median < floor).length;
        ricochet.draw(out, own, encode, {...ricochet.curve(curve, 4, 1.1), z: 3});
      }
      const level = {...ricochet.line(nullName, nullColour, 0), silent: true, area: 0.75};
      ricochet.draw(out, medians, encode, level, {case: ""});
      if (below)
        out.notes.push(
            ricochet.format.count(below, "distance lies", "distances lie") + " below the frame and " +
            (below === 1 ? "is" : "are") + " drawn on its lower edge.");
      return out;
    }
  }

  function spreadText(row) {
    const {text, count} = ricochet.format;
    return "median " + text(row.median) + " over " + count(row.count, "value", "values") +
        "; 10 % to 90 %: " + text(row.low) + " to " + text(row.high) + "; " + row.zeros + " are exactly zero";
  }
  // The null level across a chart.
  const band = (out, high) => out.marks.push({
    mark: "cells",
    name: nullName,
    colour: nullColour,
    opacity: 0.75,
    silent: true,
    z: 0,
    rows: [{high}],
    y: [null, "high"]
  });

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
