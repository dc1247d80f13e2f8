// Errors against the step and against the number of elements, log–log, one view per kind of error, one curve per
// method. Shown besides: the fitted slope over the points that follow it, and the error floor. Points at or below the
// floor are grey. Cases without an error are marks in a strip above.
{
  const {numberOf, Interval, errors} = ricochet;
  const follows = 2;  // factor within which a point follows the fitted line

  // All cases; for elements, those at the smallest step of their method.
  function casesFor(view, refined) {
    if (refined === "step") return view.all;
    const step = (one) => {
      const value = numberOf(one, "step");
      return value === null ? Infinity : value;
    };
    return view.group(view.all, view.varyingWithout(["step", "elements"])).flatMap((group) => {
      const smallest = Math.min(...group.cases.map(step));
      return group.cases.filter((one) => step(one) === smallest);
    });
  }

  class ErrorFigure {
    constructor(data, refined) {
      const {view} = data, byStep = refined === "step", cases = casesFor(view, refined);
      Object.assign(this, {data, refined, byStep, x: byStep ? ["step h", "s"] : ["elements", "1"]});
      this.error = data.finder("errors", ["error"]);
      this.order = data.finder("orders", ["refined", "error"], [refined]);
      this.line = data.finder("order_lines", ["refined", "error"], [refined]);
      this.curves = new ricochet.MethodCurves(view, cases, refined, {ignored: byStep ? [] : ["step"]});
      this.xRange = new Interval().include(...cases.map((one) => numberOf(one, refined)));
    }
    place(one) {
      const value = numberOf(one, this.refined);
      return value === null ? this.xRange.low : value;
    }
    // Rows of the table for cases that have an error, each at its place.
    rows(cases, error) {
      const found = cases.filter((one) => numberOf(one, this.refined) !== null)
                        .map((one) => ({case: one.id, at: this.place(one), ...this.error(one, [error])}));
      return found.filter((row) => Number.isFinite(row.value)).map((row) => ({...row, floor: row.floor || 0}));
    }

    figure() {
      const {curves, byStep} = this, cases = curves.facets.flatMap((facet) => facet.cases);
      const kinds = errors.kinds(this.data.rows("errors"))
                        .map((error) => ({error, range: this.range(this.rows(cases, error))}))
                        .filter(({range}) => !range.empty);
      if (!kinds.length) return null;
      const charts = curves.charts((facet) => kinds.map(({error, range}) => this.chart(error, facet, range)));
      const caption = curves.colours() +
          " The pale band under a curve is its fitted order, drawn over the points that stay within a factor of " +
          follows +
          " of it; the number at its end is the order. Grey points are at or below the error floor, which is how far " +
          "apart two references are." + (byStep ? "" : " Each method at its smallest step.");
      return {
        id: "error-" + this.refined,
        title: byStep ? "Errors against the step" : "Errors against the number of elements",
        caption,
        views: kinds.map(({error}) => error),
        charts,
        legend: curves.legend().concat(ricochet.drawnNames(charts).has(errors.floorName) ? [errors.floorEntry] : []),
        measured: {
          key: "errors",
          along: this.refined,
          values: errors.measured(kinds, (one, error) => this.error(one, [error]))
        },
      };
    }
    range(rows) {
      const out = new Interval().include(...rows.map((row) => row.value).filter((value) => value > 0));
      const floors = new Interval().include(...rows.map((row) => row.floor).filter((floor) => floor > 0));
      // A floor far below everything stays out of sight.
      if (!out.empty && !floors.empty && floors.high >= 1e-2 * out.low) out.include(Math.min(floors.high, out.high));
      return out;
    }

    chart(error, facet, range) {
      const quantity = errors.quantity(error), y = ricochet.logAxis(quantity, range), lowest = y.min,
            {exact, text, count} = ricochet.format;
      const out = ricochet.view(this.x, quantity, ricochet.logAxis(this.x, this.xRange), y), outcomes = [];
      const ofCase = (curve, find) => curve.cases.map((one) => find(one, [this.refined, error])).find(Boolean),
            all = [], zeros = [];
      for (const curve of facet.curves) {
        const said = orderText(ofCase(curve, this.order)), line = ofCase(curve, this.line),
              done = curve.cases.filter((one) => one.status === "done");
        const rows = this.rows(done, error).map((row) => ({...row, text: pointText(row, quantity, said)}));
        all.push(...rows);
        zeros.push(...rows.filter((row) => !(row.value > 0)).map((row) => curve.name + " at " + exact(row.at)));
        if (line) ricochet.fitted(out, lineRows(line, said), {x: "at", y: "error"}, curve, line.order);
        ricochet.draw(out, rows.filter((row) => row.value > 0), {x: "at", y: "value"}, errors.curve(curve));
        outcomes.push([
          curve, curve.cases.filter((one) => !done.includes(one)).map((one) => ricochet.outcome(one, this.place(one)))
        ]);
      }
      ricochet.outcomeStrip(out, outcomes, "no error");
      // The highest at each place.
      const floors =
          all.filter((row) => row.floor > 0 && all.every((other) => other.at !== row.at || other.floor <= row.floor))
              .sort((a, b) => a.at - b.at);
      const seen = floors.filter((row, k) => row.floor >= lowest && (k === 0 || floors[k - 1].at !== row.at))
                       .map(({at, floor}) => ({at, floor, text: text(floor, 3)}));
      if (seen.length) ricochet.draw(out, seen, {x: "at", y: "floor"}, floorArea(seen.length === 1));
      else if (floors.length) out.notes.push("The error floor is below this frame.");
      if (zeros.length) out.notes.push(ricochet.unseenZeros + zeros.join(", ") + ".");
      const without = facet.cases.filter((one) => one.status === "done").length - all.length;
      if (without)
        out.notes.push(
            count(without, "finished case has", "finished cases have") + " no such error: the notes say why.");
      return out;
    }
  }

  function orderText(row) {
    if (!row) return "";
    const {order} = ricochet.format, known = row.order !== null && row.low !== null && row.high !== null;
    return (known ? "order " + order(row.order) + " [" + order(row.low) + ", " + order(row.high) + "], " :
                    "no order, ") +
        row.verdict;
  }
  function pointText({value, floor}, quantity, said) {
    const {text, unit} = ricochet.format;
    return text(value, 5) + unit(quantity) +
        (floor > 0 ? (value <= floor ? ", at or below the floor of " : ", floor ") + text(floor, 3) : "") +
        (said ? "; " + said : "");
  }
  const lineRows =
      (line, text) => [{at: line.from, error: line.error_from, text}, {at: line.to, error: line.error_to, text}];
  const floorArea = (alone) => ({...errors.floorLine, ...(alone ? {symbol: "bar", size: 24} : {}), area: 0.05});

  ricochet.figure("errors", (data) => {
    if (!data.rows("errors").length) return [];
    return ["step", "elements"]
        .filter((refined) => data.view.varies(refined))
        .map((refined) => new ErrorFigure(data, refined).figure())
        .filter(Boolean);
  });
}
