// Multipliers along the branches in the complex plane, a chart per method at its finest: filled where all are inside the unit circle.
{
  const { Interval } = ricochet, frame = 1.6, looks = { "stable orbit": "#0072B2", "unstable orbit": "#D55E00" };
  const circle = Array.from({ length: 181 }, (_, k) => ({ re: Math.cos((2 * Math.PI * k) / 180), im: Math.sin((2 * Math.PI * k) / 180) }));

  function chart(branches, label, one) {
    const x = ["real part", "1"], y = ["imaginary part", "1"], all = new Interval(-frame, frame), out = ricochet.view(x, y, ricochet.valueAxis(x, all, false), ricochet.valueAxis(y, all, true));
    ricochet.draw(out, circle, { x: "re", y: "im" }, { ...ricochet.line("unit circle", ricochet.faint, 1.2), silent: true });
    const { exact, count } = ricochet.format, parameter = branches.column(one.id, "parameter"), unstable = branches.column(one.id, "unstable"), rows = [];
    let outside = 0;
    for (let i = 0; i < branches.size(one.id); ++i) {
      if (!Number.isFinite(unstable[i])) continue;
      for (const { re, im } of branches.multipliers(one.id, i)) {
        if (Math.abs(re) > frame || Math.abs(im) > frame) { ++outside; continue; }
        rows.push({ case: one.id, row: i, re, im, orbit: unstable[i] > 0 ? "unstable orbit" : "stable orbit", text: branches.branch(one.id, i).name + " at " + exact(parameter[i]) });
      }
    }
    for (const [name, colour] of Object.entries(looks)) ricochet.draw(out, rows, { x: "re", y: "im" }, { ...ricochet.dot(name, colour, "circle", 3.5), itemStyle: { color: colour, opacity: 0.55 } }, { orbit: name });
    if (outside) out.notes.push(count(outside, "multiplier lies", "multipliers lie") + " outside this frame.");
    return { title: label || "all cases", cases: [one], height: 380, views: [out], notes: [] };
  }

  ricochet.figure("multipliers", (data) => {
    if (!data.page.branches) return [];
    const branches = new ricochet.Branches(data), methods = branches.methods().map(({ label, cases }) => ({ label, one: cases[cases.length - 1] })).filter(({ one }) => branches.of(one.id).multipliers > 0);
    if (!methods.length) return [];
    return [{
      id: "multipliers", title: "Multipliers of the orbits", views: ["plane"], charts: methods.map(({ label, one }) => chart(branches, label, one)),
      legend: [{ name: "unit circle", colour: ricochet.faint, dash: "", symbol: "" }].concat(Object.entries(looks).map(([name, colour]) => ricochet.swatch(name, colour, "circle"))),
      caption: "Multipliers of the step's own map, as its contact sets are, along the branches of each method at its finest; of half a period where the orbit is symmetric. They jump where a contact set changes, and flicker across the circle.",
    }];
  });
}
