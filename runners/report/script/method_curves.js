// Cases as curves along an axis, in facets of at most eight curves where columns allow. Facets are by what must not
// share a chart, then by what is no method. Then they are by methods other than the mass matrix. Colour is the mass
// matrix; where a study has one mass only, it is the curve.
{
  const mostCurves = 8;
  // The first eight are those of curves; a diagram may overlay more methods.
  const colours = [
    "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7B4FA0", "#8C6D31", "#44AA99", "#882255",
    "#333333", "#999933"
  ];

  // Of the columns, those that become facets so that no chart has more curves than a reader can tell apart.
  function facetColumns(view, cases, columns, apart) {
    const {roleOf, isMethod} = ricochet, facets = columns.filter((column) => apart.includes(column));
    const candidates = columns.filter((column) => !apart.includes(column) && roleOf(column) !== "mass");
    for (const column of candidates.filter((one) => !isMethod(one)).concat(candidates.filter(isMethod))) {
      const most = Math.max(0, ...view.group(cases, facets).map((facet) => view.group(facet.cases, columns).length));
      if (most <= mostCurves) break;
      facets.push(column);
    }
    return facets;
  }

  // A chart of some cases, which have columns `by` in common, whose views and notes are worked out when they are first
  // looked at.
  function chartOf(title, cases, by, views, notes) {
    let seen = null, said = null;
    return {
      title,
      cases,
      by,
      get views() { return seen || (seen = views()); },
      get notes() { return said || (said = notes()); }
    };
  }

  class MethodCurves {
    // `apart` must not share a chart, `ignored` tells nothing apart; facets are chosen over the cases `among`.
    constructor(view, cases, along, {apart = [], ignored = [], among = cases, byMass = view.masses.length > 1} = {}) {
      const {roleOf, numberOf} = ricochet;
      Object.assign(this, {view, byMass});
      const others = view.varying.filter((column) => column !== along && !ignored.includes(column)),
            facets = facetColumns(view, among, others, apart);
      const curveColumns = others.filter((column) => !facets.includes(column)),
            notMass = others.filter((column) => roleOf(column) !== "mass"), names = [];
      this.facetColumns = facets;
      // Columns whose values tell a case of a facet apart.
      this.said = [along].concat(curveColumns);
      this.name = (one) => view.label(one, curveColumns) || view.massLabel(one) || "cases";
      this.facets = view.group(cases, facets).map((group) => {
        const styles = view.group(group.cases, notMass);
        const curves = view.group(group.cases, others).map((one) => {
          const first = one.cases[0], name = this.name(first);
          // Without masses to tell apart, a name has its colour in every chart.
          if (!names.includes(name)) names.push(name);
          const rank = names.indexOf(name);
          return {
            name,
            colour: byMass ? view.colour(first) : colours[rank % mostCurves],
            style: byMass ? styles.findIndex((style) => style.cases.includes(first)) : rank,
            cases: one.cases.slice().sort((a, b) => (numberOf(a, along) || 0) - (numberOf(b, along) || 0)),
          };
        });
        return {title: group.label || "all cases", cases: group.cases, curves};
      });
    }
    // A chart per facet, with the views that `draw` makes of it.
    charts(draw) {
      return this.facets.map(
          (facet, f) => chartOf(
              facet.title, facet.cases, this.facetColumns, () => draw(facet, f),
              () => this.view.outcomeNotes(facet.cases, this.said)));
    }
    legend() {
      const entries =
          this.facets.flatMap((facet) => facet.curves)
              .map(
                  ({name, colour, style, across}) =>
                      ({name, colour, dash: ricochet.svgDash(style), symbol: across ? "" : ricochet.symbol(style)}));
      return ricochet.firstOfName(entries);
    }
    // What the colours mean, for a caption.
    colours() {
      return this.byMass ? "One colour per mass matrix." : "One colour per curve (the study has one mass matrix).";
    }
  }

  Object.assign(ricochet, {MethodCurves, chartOf, mostCurves, methodColours: colours});
}
