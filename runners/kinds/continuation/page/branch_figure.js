// Branches over the parameter: tip at the strobe, solid where stable, dashed where not; special points as marks with
// their intervals.
{
  const {Interval, methodColours} = ricochet;
  const tip = ["tip displacement", "m"], colourOf = (k) => methodColours[k % methodColours.length];
  const both = "stable (solid), unstable (dashed)";

  class BranchFigure {
    constructor(branches) {
      this.branches = branches;
      this.xs = branches.range(branches.cases, "parameter");
      this.ys = branches.range(branches.cases, "tip");
      // Points of a bifurcation study.
      const parameter = branches.data.block("beneath/parameter") || [], tips = branches.data.block("beneath/tip") || [];
      this.beneath = {parameter: Array.from(parameter), tip: Array.from(tips)};
      this.beneath.tip.forEach((tip) => this.ys.include(tip));
    }
    figure() {
      const {branches} = this, methods = branches.methods(), refined = methods.filter((one) => one.cases.length > 1),
            charts = [], views = [], legend = [];
      const add = (title, curves, only, whole) => charts.push({
        title,
        cases: curves.map(({one}) => one),
        only: whole ? undefined : only,
        height: 440,
        views: [this.draw(curves)],
        notes: []
      });
      const entries = (curves, heading, only) =>
          curves.forEach(({name, colour}) => legend.push({name, colour, dash: "", symbol: "", heading, only}));
      const finest = methods.map(({cases}, k) => {
        const one = cases[cases.length - 1];
        return {one, name: branches.methodLabel(one), colour: colourOf(k)};
      });
      if (methods.length > 1 || !refined.length) {
        const only = views.push(methods.length > 1 ? "finest of each method" : "branches") - 1;
        add(methods.length > 1 ? "all methods, each at its finest" : "all cases", finest, only, !refined.length);
        entries(finest, "Method", only);
      }
      const names = ricochet.distinct(refined.flatMap(({cases}) => cases.map((one) => branches.refinedLabel(one))));
      if (refined.length) {
        const only = views.push("refined") - 1;
        for (const {label, cases} of refined) {
          const curves = cases.map((one) => {
            const name = branches.refinedLabel(one);
            return {one, name, colour: colourOf(names.indexOf(name))};
          });
          add(label || "the one method", curves, only, methods.length === 1);
          entries(curves, "Refined", only);
        }
      }
      for (const kind of this.kinds()) {
        const [words, symbol] = branches.kindWords(kind);
        legend.push(ricochet.swatch(words, "#555555", symbol, "Point"));
      }
      return {
        id: "branches",
        answers: true,
        title: "Branches of periodic orbits",
        views,
        charts,
        legend: ricochet.firstOfName(legend),
        linked: false,
        caption: [
          "Tip displacement at the strobe, absolute, against " + branches.parameter[0] + "; " + both +
              ", thin where that changes again within 3 mm of arc or within the interval of a point. Large marks: " +
              "points that the two finest cases of a refinement share, with bars where they may be; small ones: " +
              "points of one case. Click a branch for its orbit.",
          branches.said, branches.beneath
        ].filter(Boolean)
                     .join(" "),
      };
    }
    kinds() {
      return ricochet.distinct(
          this.branches.cases.flatMap((one) => this.branches.points(one).map((row) => this.branches.kind(row))));
    }

    draw(curves) {
      const {branches} = this, {parameter} = branches,
            wide = (range) => ricochet.roundOutwards(range.empty ? new Interval(0, 1) : range, 1e-9);
      const xAxis = ricochet.valueAxis(parameter, this.xs.empty ? wide(this.xs) : this.xs),
            out = ricochet.view(parameter, tip, xAxis, ricochet.valueAxis(tip, wide(this.ys)));
      if (this.beneath.tip.length)
        ricochet.draw(
            out, () => this.beneath, {x: "parameter", y: "tip"},
            {...ricochet.dot("bifurcation", "#b3b3b3", "dot", 2, 0), silent: true});
      for (const {one, name, colour} of curves) {
        for (const [look, width, dash] of [["stable", 2.2, []], ["unstable", 1.4, [5, 4]], ["flickering", 0.8, []]])
          if (look !== "flickering" || branches.flickering(one.id).includes(1))
            ricochet.draw(out, () => branches.curve(one.id, look), {x: "parameter", y: "tip"}, {
              ...ricochet.line(name, colour, width, dash),
              case: one.id,
              z: 2,
              prefer: (i, {row}) => branches.portrayed(one.id).has(row[i])
            });
        for (const rows of ricochet.groupBy(branches.points(one), (row) => [branches.kind(row), Boolean(row.name)])
                 .values())
          this.mark(out, name, colour, rows);
      }
      // A special point opens the orbit that it is.
      const rowOf = ({mark, row, i}) =>
                (row.branch ? branches.rowOf(row.case, row) : ricochet.plot.rowsOf(mark).row[i]),
            curveOf = ({mark, row}) => curves.find(({one}) => one.id === (row.case || mark.case));
      out.open = (found) => {
        const {one, colour} = curveOf(found), row = rowOf(found);
        if (row >= 0) ricochet.showBranchOrbit(branches, one.id, row, colour);
      };
      out.words = (found) =>
          (found.row.text ? ricochet.pointWords(out, [found]) :
                            this.words(curveOf(found).one.id, rowOf(found), curveOf(found).name));
      return out;
    }
    // Points of one kind; those without a name are small.
    mark(out, name, colour, rows) {
      const {branches} = this, kind = branches.kind(rows[0]), named = Boolean(rows[0].name) || kind === "mark",
            [words, symbol, full] = branches.kindWords(kind), size = named ? full : 4, {text, unit} = ricochet.format,
            tags = [words, name], own = words + ", " + name;
      const said = (row) => (row.name || words) + ", " + row.branch +
          (row.low !== null && row.high !== null ?
               ", " + text(row.low, 8) + " to " + text(row.high, 8) + unit(branches.parameter) :
               "") +
          (row.note ? "; " + row.note : "");
      const points = rows.map((row) => ({
                                case: row.case,
                                branch: row.branch,
                                point: row.point,
                                parameter: row.parameter,
                                tip: row.tip_displacement,
                                text: said(row)
                              }));
      const bars = rows.filter((row) => row.low !== null && row.high !== null && row.high > row.low)
                       .map((row) => ({low: row.low, high: row.high, tip: row.tip_displacement}));
      if (named && bars.length)
        ricochet.draw(
            out, ricochet.ends(bars, "low", "high"), {x: "end", y: "tip"},
            {...ricochet.line(own, ricochet.lighten(colour, 0.5), 5), tags, silent: true, z: 3});
      ricochet.draw(
          out, points, {x: "parameter", y: "tip"},
          {...ricochet.dot(own, colour, symbol, size, named ? 5 : 4), tags, hollow: named, edge: 2});
    }
    words(id, row, name) {
      const {branches} = this, {escape, shown, unit} = ricochet.format,
            line = (what, text) => '<div class="tip-row">' + escape(what) + "<b>" + escape(text) + "</b></div>",
            unstable = branches.column(id, "unstable")[row];
      return "<div>" + escape(branches.parameter[0]) + " = " + shown(branches.column(id, "parameter")[row], 9) +
          escape(unit(branches.parameter)) + '</div><div class="fine">' + escape(name) + "</div>" +
          line(branches.branch(id, row).name, unstable > 0 ? "unstable" : "stable") +
          line(tip[0], shown(branches.column(id, "tip")[row], 8) + " m") + '<div class="fine">click: its orbit</div>';
    }
  }

  ricochet.figure("branches", (data) => {
    if (!data.page.branches) return [];
    const branches = new ricochet.Branches(data);
    return branches.cases.length ? [new BranchFigure(branches).figure()] : [];
  });
}
