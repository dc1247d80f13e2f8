// The largest step of each method, predicted and observed.
{
  const mostRows = 22, none = "no limit", colours = {open: "#44AA99", closed: "#882255"};  // of no mass matrix

  ricochet.figure("limit-dots", (data) => {
    const {view} = data, {text} = ricochet.format,
          found = data.rows("step_limits")
                      .filter(
                          (row) => row.counted && data.byId.has(row.case) &&
                              (row.expected !== null || row.observed !== null));
    if (!found.length) return [];
    const cases = ricochet.distinct(found.map((row) => data.byId.get(row.case))),
          label = ricochet.rowLabels(view, cases, view.varying, mostRows);
    const rows = found.map((row) => {
      const one = data.byId.get(row.case), contact = row.closed ? "closed" : "open",
            said = [["predicted", row.expected], ["observed", row.observed]].filter(([, value]) => value !== null);
      return {
        name: label(one),
        contact,
        predicted: row.expected,
        observed: row.observed,
        text: (view.label(one) || "the one method") + ", " + contact + ": " +
            said.map(([what, value]) => what + " " + text(value, 4) + " s").join(", ")
      };
    });
    const counted = ricochet.distinct(data.rows("step_limits")
                                          .filter((row) => row.counted && !row.refused && data.byId.has(row.case))
                                          .map((row) => data.byId.get(row.case))),
          without = counted.filter((one) => !cases.includes(one));
    // Only where each row is one method.
    const limited = ricochet.distinct(rows.map((row) => row.name)),
          arrows = view.group(cases.concat(without), view.varying).length <= mostRows,
          unlimited = arrows ? ricochet.distinct(without.map(label)) : [];
    const names = arrows ? unlimited.concat(limited) : limited,
          range = new ricochet.Interval().include(
              ...rows.flatMap((row) => [row.predicted, row.observed]).filter((value) => value > 0));
    if (range.empty) return [];
    const x = ["largest step h", "s"],
          out = ricochet.namedRows(names, x, ricochet.logAxis(x, range), names.length > 12 ? 19 : 26), legend = [];
    for (const [contact, colour] of Object.entries(colours))
      for (const [what, draw] of [
               ["predicted", (name) => ricochet.ring(name, colour, 10)],
               ["observed", (name) => ricochet.dot(name, colour, "circle", 4, 4)]]) {
        const own = rows.filter((row) => row.contact === contact && row[what] > 0), name = contact + ", " + what;
        if (!own.length) continue;
        ricochet.draw(out, own, {x: what, y: "name"}, {...draw(name), shift: [0, contact === "open" ? -4 : 4]});
        legend.push({...ricochet.swatch(name, colour, "circle"), hollow: what === "predicted"});
      }
    if (arrows && unlimited.length) {
      ricochet.draw(
          out,
          unlimited.map(
              (name) => ({name, end: out.xAxes[0].max, text: name + ": no limit within the steps of the study"})),
          {x: "end", y: "name"}, {...ricochet.dot(none, "#555555", "triangle-right", 10, 4), shift: [-6, 0]});
      legend.push(ricochet.swatch(none, "#555555", "triangle-right"));
    }
    if (without.length && !arrows)
      out.notes.push("No limit within the steps of the study: " + view.describe(without, counted) + ".");
    return [{
      id: "limit-dots",
      answers: true,
      title: "Largest step of each method",
      views: ["step"],
      legend,
      charts: [{title: "all cases", height: out.height, views: [out], notes: []}],
      caption:
          "Ring: predicted by the spectrum of one step. Dot: observed by marching. Where the dot is in its ring, " +
          "both agree. Open: the structure alone; closed: with contact.",
    }];
  });
}
