// Run time against one error, all methods in one chart: those that nothing beats by name, the others in grey.
{
  const grey = "#C4C4C4", beaten = "beaten by another", mostNames = 12;

  // The kind of error that tells the methods apart most: its values, above their floors, span the most.
  function telling(rows) {
    const span = (error) => {
      const values = rows.filter((row) => row.error === error && row.value > row.floor).map((row) => row.value);
      return values.length ? Math.max(...values) / Math.min(...values) : 0;
    };
    return ricochet.distinct(rows.map((row) => row.error)).sort((a, b) => span(b) - span(a))[0];
  }

  ricochet.figure("work-front", (data) => {
    const {view} = data,
          known = data.rows("work_points")
                      .filter((row) => row.none === "" && row.value > 0 && row.seconds > 0 && data.byId.has(row.case)),
          error = telling(known);
    if (!error) return [];
    const scene = view.varyingWithout(["mass", "contact", "friction", "time", "march", "elements", "step"]),
          scenes = view.group(known.map((row) => data.byId.get(row.case)), scene), [first] = scenes;
    const methods =
              view.varying.filter((column) => column !== "elements" && column !== "step" && !scene.includes(column)),
          label = (one) => ricochet.shorten(view.label(one, methods) || "the one method");
    const text = ricochet.format.text,
          rows =
              known.filter((row) => row.error === error && first.cases.includes(data.byId.get(row.case))).map((row) => {
                const one = data.byId.get(row.case), name = label(one);
                return {
                  case: row.case,
                  value: row.value,
                  seconds: row.seconds,
                  name,
                  shown: row.on_front ? name : beaten,
                  text: view.label(one) + ": " + text(row.value, 3) + ", " + text(row.seconds, 3) + " s"
                };
              });
    const front = rows.filter((row) => row.shown !== beaten).sort((a, b) => a.value - b.value),
          names = ricochet.distinct(front.map((row) => row.shown)).slice(0, mostNames), legend = [];
    const x = ricochet.errors.quantity(error), y = ["run time", "s"],
          range = (column) => new ricochet.Interval().include(...rows.map((row) => row[column]));
    const out = ricochet.view(x, y, ricochet.logAxis(x, range("value")), ricochet.logAxis(y, range("seconds")));
    ricochet.draw(
        out, front, {x: "value", y: "seconds"}, {...ricochet.line("Pareto front", "#E8D95A", 9), cap: "round"});
    ricochet.draw(out, rows, {x: "value", y: "seconds"}, ricochet.dot(beaten, grey, "circle", 5, 2), {shown: beaten});
    // The methods of a mass matrix are told apart by their marks; of one mass matrix alone by colours, too.
    const byMass = view.masses.length > 1, used = {};
    names.forEach((name, k) => {
      const colour = byMass ? view.colour(data.byId.get(rows.find((row) => row.shown === name).case)) :
                              ricochet.methodColours[k % ricochet.methodColours.length],
            rank = byMass ? used[colour] || 0 : k, symbol = ricochet.symbol(rank), hollow = rank > 5;
      used[colour] = rank + 1;
      ricochet.draw(
          out, rows, {x: "value", y: "seconds"}, {...ricochet.dot(name, colour, symbol, 10, 4), hollow}, {shown: name});
      legend.push({...ricochet.swatch(name, colour, symbol), hollow});
    });
    if (rows.some((row) => row.shown === beaten)) legend.push(ricochet.swatch(beaten, grey, "circle"));
    if (scenes.length > 1) out.notes.push("Of " + scenes.length + " scenes the first: " + first.label + ".");
    return [{
      id: "work-front",
      answers: true,
      title: "Which methods nothing beats",
      views: [error],
      legend,
      charts: [{title: "all methods", height: 360, views: [out], notes: []}],
      caption: "Left and low is better; a point per method and step. The band joins the cases that no other is both " +
          "faster and more precise than, in " + error + ", the error that tells most." +
          (byMass ? " One colour per mass matrix." : ""),
    }];
  });
}
