// A number of each case against an axis of the study: a figure per axis worth one, a curve per method.
{
  const { numberOf, textOf, roleOf, Interval } = ricochet;

  // The step where it varies, other numbers with at least three values.
  function axisColumns(view) {
    const numeric = view.varying.filter((column) => view.all.some((one) => numberOf(one, column) !== null));
    return numeric.filter((column) => column === "step").concat(numeric.filter((column) => column !== "step" && view.values(column).length >= 3));
  }

  // A subject has id, title, caption and values {view, quantity, logarithmic, of, hollow}: `of` a number of a case or null, hollow marks on a condition.
  class AlongAxis {
    constructor(view, column) {
      const unit = view.unit(column);
      Object.assign(this, { view, column, x: [column === "step" ? "step h" : column, unit || "1"], xRange: new Interval() });
      this.others = view.varyingWithout([column]);
      this.facetColumns = ricochet.facetColumns(view, view.all, this.others, []);
      this.xRange.include(...view.all.map((one) => numberOf(one, column)).filter((value) => value !== null));
      this.logarithmic = this.xRange.low > 0 && this.xRange.high >= 9 * this.xRange.low;
      const onAxis = view.all.filter((one) => numberOf(one, column) !== null), offAxis = view.all.filter((one) => numberOf(one, column) === null);
      this.facets = view.group(onAxis, this.facetColumns).map((facet) => ({ title: facet.label || "all cases", cases: facet.cases, series: this.seriesOf(facet, offAxis) }));
    }
    name(one) {
      return this.view.label(one, this.others.filter((column) => !this.facetColumns.includes(column))) || this.view.massLabel(one) || "cases";
    }
    seriesOf(facet, offAxis) {
      const { view, column } = this, styles = view.group(facet.cases, this.others.filter((one) => roleOf(one) !== "mass"));
      const out = view.group(facet.cases, this.others).map((group) => ({
        name: this.name(group.cases[0]), colour: view.colour(group.cases[0]), style: styles.findIndex((style) => style.cases.includes(group.cases[0])), reference: false,
        cases: group.cases.slice().sort((a, b) => numberOf(a, column) - numberOf(b, column)),
      }));
      // Methods without this parameter, otherwise as this chart's: what the parameter's limit is compared with.
      if (roleOf(column) === column) return out;
      const common = this.facetColumns.filter((one) => roleOf(one) !== roleOf(column));
      for (const one of offAxis)
        if (one.status === "done" && out.length < 2 * ricochet.mostCurves && common.every((name) => textOf(one, name) === textOf(facet.cases[0], name)))
          out.push({ name: this.name(one), colour: view.colour(one), style: 0, cases: [one], reference: true });
      return out;
    }

    figure(subject) {
      const values = subject.values.map((value) => ({ value, ranges: this.facets.map((facet) => this.range(facet, value)) })).filter(({ ranges }) => ranges.some((range) => !range.empty));
      if (!values.length) return null;
      const said = [this.column].concat(this.others.filter((column) => !this.facetColumns.includes(column)));
      const charts = this.facets.map((facet) => ({ title: facet.title, views: [], notes: this.view.outcomeNotes(facet.cases, said) }));
      for (const { value, ranges } of values) {
        const all = ranges.reduce((sum, range) => sum.join(range), new Interval()), frames = ricochet.sharedFrames(ranges);
        this.facets.forEach((facet, f) => charts[f].views.push(this.chart(value, facet, value.logarithmic ? { range: all, own: false } : frames[f])));
      }
      const legend = new Map();
      for (const facet of this.facets)
        for (const one of facet.series)
          if (!legend.has(one.name)) legend.set(one.name, { name: one.name, colour: one.colour, dash: one.reference ? "2 3" : ricochet.svgDash(one.style), symbol: one.reference ? "" : ricochet.symbol(one.style) });
      return { id: subject.id + "-" + ricochet.slug(this.column), title: subject.title + " against " + this.x[0], caption: subject.caption, views: values.map(({ value }) => value.view), charts, legend: Array.from(legend.values()) };
    }
    range(facet, value) {
      const out = new Interval();
      for (const one of facet.series.flatMap((series) => series.cases)) {
        const y = one.status === "done" ? value.of(one) : null;
        if (y !== null && (!value.logarithmic || y > 0)) out.include(y);
      }
      return out;
    }

    chart(value, facet, frame) {
      const range = value.logarithmic ? frame.range : ricochet.roundOutwards(frame.range, 2e-3), fromZero = range.low <= 0 && range.high >= 0;
      const y = value.logarithmic ? ricochet.logAxis(value.quantity, range, true) : ricochet.valueAxis([ricochet.format.withUnit(value.quantity) + (fromZero ? "" : ", axis not from 0"), "1"], range, true);
      const x = this.logarithmic ? ricochet.logAxis(this.x, this.xRange, false) : ricochet.valueAxis(this.x, ricochet.roundOutwards(this.xRange, 1e-12), false);
      const out = ricochet.view(this.x, value.quantity, x, [y, ricochet.gutterAxis()]), stacked = new Map(), zeros = [];
      if (!value.logarithmic && frame.own) out.notes.push("This chart has its own scale: its values are over 4 times those of most others.");
      for (const one of facet.series) this.draw(one, value, x, stacked, zeros, out.option.series);
      if (zeros.length) out.notes.push("Exactly 0, which a logarithmic axis cannot show: " + zeros.join("; ") + ".");
      return out;
    }
    draw(series, value, x, stacked, zeros, into) {
      const items = [], marks = [], unseen = [];
      for (const one of series.cases) {
        const given = numberOf(one, this.column), at = given === null ? x.min : given, y = value.of(one);
        if (one.status !== "done") {
          const below = stacked.get(at) || 0;
          stacked.set(at, below + 1);
          marks.push({ value: [at, 0.95 - 0.085 * below], mark: ricochet.format.mark(one.status), text: one.status + ": " + one.reason });
        } else if (y !== null && value.logarithmic && !(y > 0)) {
          unseen.push(ricochet.format.exact(at));
        } else if (y !== null) {
          items.push(value.hollow && value.hollow(one) ? { value: [at, y], itemStyle: ricochet.hollow(series.colour) } : { value: [at, y] });
        }
      }
      if (unseen.length) zeros.push(series.name + (series.reference ? "" : " at " + unseen.join(", ")));
      const across = series.reference && items.length ? [{ value: [x.min, items[0].value[1]] }, { value: [x.max, items[0].value[1]] }] : items;
      const line = ricochet.curve(series.name, series.colour, series.reference ? 2 : series.style, across, 8, series.reference ? 1.2 : 1.6);
      if (series.reference) line.symbol = "none";
      into.push(line);
      if (marks.length) into.push(Object.assign(ricochet.marks(series.name, series.colour, marks), { yAxisIndex: 1 }));
    }
  }

  // The figures of a subject, one per axis.
  ricochet.alongAxes = (data, subject) => axisColumns(data.view).map((column) => new AlongAxis(data.view, column).figure(subject)).filter(Boolean);
}
