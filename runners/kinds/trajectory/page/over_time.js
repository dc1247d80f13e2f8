// A column of the sampled curves against time, the zoom of all charts linked. Either a chart per method with a curve
// per step (or mass), or a chart per step with a curve per method. Curves are shown as they are, or less one of them.
{
  const {numberOf, measureOf, Interval} = ricochet;
  const drawnWhole = 4000;  // points of a curve up to which every one is drawn: a chart is about 500 pixels wide

  // The scales of a column: as it is, as a ratio to the start, as the modulus of its change. Subtracting first keeps an
  // unchanged value exactly 0.
  const scaled = {
    difference: (y) => y,
    value: (y) => y,
    ratio: (y, start) => (1 / start) * y,
    change: (y, start) => Math.abs((1 / start) * (y - start))
  };
  const scaleNames = {ratio: ["E / E_in", "1"], change: ["|E / E_in − 1|", "1"]};
  const startless = (curve, scale) =>
      (scale === "ratio" || scale === "change") && curve.start === null;  // no start to be compared with
  function valuesOf(curve, scale) {
    if (startless(curve, scale)) return [];
    if (scale === "difference") return curve.base ? less(curve, curve.base) : [];
    return Float64Array.from(curve.values, (y) => scaled[scale](y, curve.start));
  }
  // A curve less another, which is straight between its samples; not a number where that has none.
  function less({t, values}, base) {
    let k = 0;
    return Float64Array.from(values, (y, i) => {
      while (k + 2 < base.t.length && base.t[k + 1] < t[i]) ++k;
      const from = base.t[k], to = base.t[k + 1];
      if (from === t[i] || to === undefined) return y - base.values[k];
      return t[i] < from || t[i] > to ?
          NaN :
          y - base.values[k] - ((t[i] - from) / (to - from)) * (base.values[k + 1] - base.values[k]);
    });
  }

  // What may be told apart within one chart: the step; methods, as far as a chart holds their curves; else the first
  // axis that varies.
  function overlays(view) {
    const {roleOf} = ricochet, {roles} = view.data.page,
          out = view.varies("step") ? [{name: "steps", columns: ["step"]}] : [];
    for (let some = roles.slice(); some.length; some.pop()) {
      const columns = view.varying.filter((column) => some.includes(roleOf(column))),
            most =
                Math.max(0, ...view.group(view.all, view.varyingWithout(columns)).map((facet) => facet.cases.length));
      if (!columns.length || most > ricochet.mostCurves || most < 2) continue;
      out.push({
        name: some.filter((role) => columns.some((column) => roleOf(column) === role)).length > 1 ? "methods" :
                                                                                                    "masses",
        columns
      });
      break;
    }
    return out.length ? out : [{name: view.varying[0] || "cases", columns: view.varying.slice(0, 1)}];
  }

  class OverTime {
    // `picked`: places in the lists of what is overlaid, and of the curves that others are taken less.
    constructor(data, subject, picked = [0, 0]) {
      const {view} = data;
      Object.assign(this, {data, view, subject, picked, overlays: overlays(view)});
      this.columns = this.overlays[picked[0]].columns;
      const byStep = this.columns[0] === "step", step = (one) => numberOf(one, "step") || 0;
      this.byMass = this.columns.length > 0 && this.columns.every((column) => ricochet.roleOf(column) === "mass");
      this.byMethod = !byStep && !this.byMass && this.columns.length > 0;
      // Finest step first; other values in order of appearance.
      const ranked = byStep ? view.all.slice().sort((a, b) => step(a) - step(b)) : view.all;
      this.ranks = ricochet.distinct(ranked.map((one) => view.label(one, this.columns)));
      this.facets =
          view.group(view.all, view.varyingWithout(this.columns))
              .map((facet) => ({title: facet.label || "all cases", cases: facet.cases, curves: this.curvesOf(facet)}));
      const base = this.ranks[Math.min(picked[1], this.ranks.length - 1)];
      this.baseName = base || "";
      for (const {curves} of this.facets)
        for (const curve of curves) curve.base = curves.find((other) => other.label === base);
    }
    // Coarser steps are wider and lighter: where curves coincide, each still shows beside the finest.
    style(one, colour) {
      const {view, ranks, byMass} = this, label = view.label(one, this.columns), rank = ranks.indexOf(label),
                          shade = ranks.length < 2 ? 0 : 0.5 * rank / (ranks.length - 1);
      return {
        label,
        name: label || view.massLabel(one) || "curve",
        rank,
        colour: byMass    ? view.colour(one) :
            this.byMethod ? ricochet.methodColours[rank % ricochet.mostCurves] :
                            ricochet.lighten(colour, shade),
        width: byMass ? 1.6 : 1.4 + 0.8 * Math.min(rank, 3),
        dash: byMass ? 0 : rank,
      };
    }
    curvesOf(facet) {
      const out = [];
      for (const one of facet.cases) {
        const curve = this.data.curve(one, this.subject.column), measured = measureOf(one, "energy_brought_in"),
              start = curve && (measured === null ? curve.y[0] : measured);
        if (curve)
          out.push({
            one,
            t: curve.x,
            values: curve.y,
            start: start > 0 ? start : null,
            ...this.style(one, this.view.colour(one))
          });
      }
      // The finest last, on top of the others.
      return out.sort((a, b) => b.rank - a.rank);
    }

    figure() {
      const {subject, view, facets} = this, curves = facets.flatMap((facet) => facet.curves);
      if (!curves.length) return null;
      const several = facets.some((facet) => facet.curves.length > 1);
      const scales = subject.scales.concat(several ? ["difference"] : [])
                         .filter((scale) => curves.some((curve) => !startless(curve, scale)));
      const frames = scales.map(
          (scale) => ricochet.sharedFrames(facets.map((facet) => this.range(facet, scale)), scale === "change"));
      const charts = facets.map(
          (facet, f) => ricochet.chartOf(
              facet.title, facet.cases, view.varyingWithout(this.columns),
              () => (facet.curves.length ? scales.map((scale, k) => this.chart(facet, scale, frames[k][f])) : []),
              () => view.outcomeNotes(facet.cases, this.columns)));
      const thinned = curves.some((curve) => curve.values.length > drawnWhole);
      const more = " Of curves over " + drawnWhole +
          " points the smallest and the largest of each pixel are drawn; zooming in shows every sample.";
      const entries = view.all.map((one) => this.style(one, view.masses.length > 1 ? "#555555" : view.colour(one)))
                          .map(({name, colour, dash}) => ({name, colour, dash: ricochet.svgDash(dash)}));
      return {
        id: subject.id,
        title: subject.title,
        caption: subject.caption + (thinned ? more : ""),
        views: scales.map((scale) => ricochet.format.withUnit(this.quantity(scale))),
        charts,
        legend: ricochet.firstOfName(entries),
        overTime: true,
        linked: true,
        ...this.choices(several),
        measured: {key: subject.id, along: "step", ...subject.measured},
      };
    }
    // What a reader picks: what is overlaid, and which curve the others are taken less.
    choices(several) {
      const {data, subject, overlays, picked, ranks} = this;
      const choices = [
        {name: "Overlay", options: overlays.map(({name}) => name), at: picked[0]},
        {name: "Difference from", options: several ? ranks : [], at: picked[1]}
      ];
      const pick = (next) => (next[0] === picked[0] ? next : [next[0], 0]);
      return {
        choices: choices.filter(({options}) => options.length > 1),
        remake: (next) => new OverTime(data, subject, pick(overlays.length > 1 ? next : [0, ...next])).figure()
      };
    }
    quantity(scale) {
      const [name, unit] = this.subject.quantity;
      return scale === "difference" ? ["difference in " + name, unit] : scaleNames[scale] || this.subject.quantity;
    }

    // Of the finished curves, and of the others as far as they stay in sight. On a logarithmic axis those count up to a
    // thousand times the finished ones. On any other they count where none finished, up to three times their start.
    range(facet, scale) {
      const range = new Interval(), logarithmic = scale === "change";
      const include = (finished, bound) => {
        for (const curve of facet.curves.filter(({one}) => (one.status === "done") === finished))
          for (const y of valuesOf(curve, scale))
            if (Math.abs(y) <= bound && (!logarithmic || y > 0)) range.include(y);
      };
      include(true, Infinity);
      if (logarithmic) {
        include(false, range.empty ? 1e6 : 1e3 * Math.max(1, range.high));
      } else if (range.empty) {
        const start = Math.max(0, ...facet.curves.map((curve) => Math.abs(valuesOf(curve, scale)[0] || 0)));
        include(false, start > 0 ? 3 * start : Infinity);
      }
      return range;
    }

    chart(facet, scale, frame) {
      const {subject} = this, quantity = this.quantity(scale), x = ["t", "s"],
            stops = subject.withStops && scale !== "difference" ? this.stops() : [], time = new Interval();
      if (frame.range.empty && scale === "change")
        return {
          ...ricochet.view(x, quantity, {}, {}),
          nothing: true,
          notes: ["No sample differs from the start: a logarithmic axis has nothing to show."]
        };
      let range = frame.range.empty ? new Interval(0, 1) : frame.range.copy();
      if (scale === "difference" || (scale === "value" && subject.fromZero)) range.include(0);
      range.include(...stops.map((stop) => 1.04 * stop));
      range = scale === "change" ? ricochet.wholeDecades(range) :
                                   ricochet.roundOutwards(range, scale === "ratio" ? 2e-3 : 1e-12);
      for (const {t} of facet.curves) time.include(t[0], t[t.length - 1]);
      if (time.low > 0 && time.low < 0.01 * time.high) time.low = 0;
      const y = scale === "change" ? ricochet.logAxis(quantity, range) : ricochet.heightAxis(quantity, range),
            out = ricochet.view(x, quantity, ricochet.valueAxis(x, time), y, true);
      if (frame.own) out.notes.push(ricochet.ownScale);
      for (const curve of facet.curves) {
        if (scale === "difference" && !curve.base) continue;
        if (startless(curve, scale)) out.notes.push(curve.name + ": no energy was brought in, so no ratio to it.");
        else this.draw(out, curve, scale, range);
      }
      if (scale === "difference")
        out.notes.push(
            facet.curves.some(({base}) => base) ? "Less the curve of " + ricochet.shorten(this.baseName) + "." :
                                                  "No curve of " + ricochet.shorten(this.baseName) + " here.");
      const unseen = scale === "change" ?
          facet.curves.map((curve) => ({curve, zeros: valuesOf(curve, scale).filter((value) => value === 0).length}))
              .filter(({zeros}) => zeros > 0) :
          [];
      if (unseen.length)
        out.notes.push(
            "Samples equal to the start exactly, which a logarithmic axis cannot show: " +
            unseen.map(({curve, zeros}) => curve.name + " " + zeros + " of " + curve.values.length).join(", ") + ".");
      // Stops that lie on each other in a wide frame share a label.
      stops.forEach(
          (stop, k) => out.marks.push(ricochet.rule(
              "stops", {y: stop},
              k === 0 || Math.abs(stop - stops[k - 1]) > 0.12 * (range.high - range.low) ? "stop" : "")));
      return out;
    }
    draw(out, curve, scale, range) {
      const {text, unit, mark} = ricochet.format, values = valuesOf(curve, scale), {name, width} = curve,
                         {status, reason} = curve.one;
      const style = {
        ...ricochet.line(name, curve.colour, width, ricochet.dash(curve.dash)),
        case: curve.one.id,
        rising: true,
        ...(values.length < 2 ? {symbol: "circle", size: 5} : {})
      };
      ricochet.draw(out, () => ({t: curve.t, value: valuesOf(curve, scale)}), {x: "t", y: "value"}, style);
      const largest = values.reduce((most, y) => (Number.isFinite(y) && Math.abs(y) > Math.abs(most) ? y : most), 0);
      if (largest > range.high || largest < range.low)
        out.notes.push(name + ": leaves the frame, up to " + text(largest) + unit(out.y) + ".");
      // A mark where a curve that did not finish stops.
      const last = values.findLastIndex(Number.isFinite);
      if (status === "done" || last < 0) return;
      const row = {
        case: curve.one.id,
        at: curve.t[last],
        height: Math.min(Math.max(values[last], range.low), range.high),
        mark: mark(status),
        text: status + " at t = " + text(curve.t[last]) + " s: " + reason
      };
      ricochet.drawMarks(out, curve, [row], {yAxis: 0, apart: undefined});
    }
    // Positions of the stops where the study gives them as plain numbers.
    stops() {
      const stops = (this.data.study.resolved.scene || {}).stops || {};
      return ["lower", "upper"]
          .map((side) => stops[side])
          .filter((stop) => stop !== null && stop !== undefined && String(stop).trim() !== "")
          .map(Number)
          .filter(Number.isFinite);
    }
  }

  ricochet.overTime = (data, subject) => [new OverTime(data, subject).figure()].filter(Boolean);
}
