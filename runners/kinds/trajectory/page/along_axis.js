// A number of each case against an axis of the study: a figure per axis worth one, a curve per method.
{
  const {numberOf, textOf, roleOf, Interval} = ricochet;

  // The step where it varies, other numbers with at least three values.
  function axisColumns(view) {
    const numeric = view.varying.filter((column) => view.all.some((one) => numberOf(one, column) !== null));
    return numeric.filter((column) => column === "step")
        .concat(numeric.filter((column) => column !== "step" && view.values(column).length >= 3));
  }

  // A subject has id, title, caption and values {view, quantity, logarithmic, of, hollow}. `of` gives a number of a
  // case or null; `hollow` tells which marks are hollow.
  class AlongAxis {
    constructor(view, column) {
      const onAxis = view.all.filter((one) => numberOf(one, column) !== null),
            offAxis = view.all.filter((one) => !onAxis.includes(one));
      Object.assign(
          this, {column, x: [column === "step" ? "step h" : ricochet.said(column), view.unit(column) || "1"]});
      this.xRange = new Interval().include(...onAxis.map((one) => numberOf(one, column)));
      this.curves = new ricochet.MethodCurves(view, onAxis, column, {among: view.all, byMass: true});
      // Methods without this parameter, otherwise as the chart's: what the parameter's limit is compared with. They are
      // drawn across.
      const common = this.curves.facetColumns.filter((one) => roleOf(one) !== roleOf(column));
      for (const {cases, curves} of roleOf(column) === column ? [] : this.curves.facets)
        for (const one of offAxis)
          if (one.status === "done" && curves.length < 2 * ricochet.mostCurves &&
              common.every((name) => textOf(one, name) === textOf(cases[0], name)))
            curves.push({name: this.curves.name(one), colour: view.colour(one), style: 2, cases: [one], across: true});
    }

    figure(subject) {
      const framesOf = (value) =>
          ricochet.sharedFrames(this.curves.facets.map((facet) => this.range(facet, value)), value.logarithmic);
      const values = subject.values.map((value) => ({value, frames: framesOf(value)}))
                         .filter(({frames}) => frames.some((frame) => !frame.range.empty));
      if (!values.length) return null;
      const charts =
          this.curves.charts((facet, f) => values.map(({value, frames}) => this.chart(value, facet, frames[f])));
      return {
        id: subject.id + "-" + ricochet.slug(this.column),
        title: subject.title + " against " + this.x[0],
        caption: subject.caption,
        views: values.map(({value}) => value.view),
        charts,
        legend: this.curves.legend(),
        measured: {key: subject.id, along: this.column, values: subject.values}
      };
    }
    // Rows of finished cases that have the value.
    rows(cases, value) {
      const rows = cases.filter((one) => one.status === "done").map((one) => ({
                                                                      case: one.id,
                                                                      at: numberOf(one, this.column),
                                                                      height: value.of(one),
                                                                      hollow: Boolean(value.hollow && value.hollow(one))
                                                                    }));
      return rows.filter((row) => row.height !== null);
    }
    range(facet, value) {
      const heights = facet.curves.flatMap((curve) => this.rows(curve.cases, value)).map((row) => row.height);
      return new Interval().include(...heights.filter((height) => !value.logarithmic || height > 0));
    }

    chart(value, facet, frame) {
      // Counts that are all the same stand among counts.
      const {quantity, logarithmic} = value,
                       counts = facet.curves.every(
                           (curve) => this.rows(curve.cases, value).every((row) => Number.isInteger(row.height)));
      const least = counts ? 4 : ricochet.leastSpan(frame.range),
            y = logarithmic ? ricochet.logAxis(quantity, frame.range) :
                              ricochet.heightAxis(quantity, ricochet.roundOutwards(frame.range, least));
      const whole = ricochet.logarithmicAxis(this.xRange),
            x = ricochet.axisOf(whole, this.x, whole ? this.xRange : ricochet.roundOutwards(this.xRange, 1e-12));
      const out = ricochet.view(this.x, quantity, x, y), zeros = [];
      if (!logarithmic && frame.own) out.notes.push(ricochet.ownScale);
      for (const curve of facet.curves) {
        const rows = this.rows(curve.cases, value), shown = rows.filter((row) => !logarithmic || row.height > 0),
              unseen = rows.filter((row) => !shown.includes(row));
        if (unseen.length)
          zeros.push(
              curve.name +
              (curve.across ? "" : " at " + unseen.map((row) => ricochet.format.exact(row.at)).join(", ")));
        if (curve.across)
          ricochet.draw(
              out, shown.flatMap((row) => [x.min, x.max].map((at) => ({...row, at}))), {x: "at", y: "height"},
              {...ricochet.curve(curve, 8, 1.2), symbol: ""});
        else ricochet.draw(out, shown, {x: "at", y: "height"}, ricochet.hollowCurve(curve, shown));
      }
      const unfinished = ({cases}) => cases.filter((one) => one.status !== "done");
      ricochet.outcomeStrip(
          out,
          facet.curves.map(
              (curve) => [curve, unfinished(curve).map((one) => ricochet.outcome(one, numberOf(one, this.column)))]));
      if (zeros.length) out.notes.push(ricochet.unseenZeros + zeros.join("; ") + ".");
      return out;
    }
  }

  // The figures of a subject, one per axis; how cases lie along an axis is worked out once for all subjects.
  const known = new Map();
  const along = (view, column) => known.get(column) || known.set(column, new AlongAxis(view, column)).get(column);
  ricochet.alongAxes = (data, subject) =>
      axisColumns(data.view).map((column) => along(data.view, column).figure(subject)).filter(Boolean);
}
