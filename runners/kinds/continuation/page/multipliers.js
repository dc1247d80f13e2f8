// Multipliers along the branches in the complex plane, a chart per method at its finest. Raw ones are dots; those of
// the half-step rule are a line.
{
  const {Interval} = ricochet, frame = 1.6, side = 320, least = 0.5, farthest = 0.2, lineName = "half-step rule",
        lineColour = "#000000", looks = {"stable orbit": "#0072B2", "unstable orbit": "#D55E00"};
  const circle = Array.from(
      {length: 181}, (_, k) => ({re: Math.cos((2 * Math.PI * k) / 180), im: Math.sin((2 * Math.PI * k) / 180)}));

  // The real multiplier nearest −1 and the pair nearest the circle along each branch, by the half-step rule. A line is
  // broken where a run of contact comes or goes, and where another one becomes the nearest.
  function halfStep(branches, id) {
    const of = branches.column(id, "of"), runs = branches.column(id, "runs"), out = [],
          within = (value) => Math.abs(value) <= frame;
    const follow = (re, im) => {
      let last = null;
      for (let i = 0; i < of.length; ++i) {
        const here = {re: re(i), im: im(i)}, size = Math.hypot(here.re, here.im),
              shown = within(here.re) && within(here.im) && size >= least,
              joined = last && of[i] === of[i - 1] && runs[i] === runs[i - 1] &&
            Math.hypot(here.re - last.re, here.im - last.im) < farthest;
        if (last && !(shown && joined)) out.push({re: null, im: null});
        if (shown) out.push(here);
        last = shown ? here : null;
      }
      if (last) out.push({re: null, im: null});
    };
    const half = branches.column(id, "half"), re = branches.column(id, "half_re"), im = branches.column(id, "half_im");
    follow((i) => half[i], (i) => (Number.isFinite(half[i]) ? 0 : NaN));
    for (const sign of [1, -1]) follow((i) => re[i], (i) => sign * im[i]);
    return out;
  }

  function chart(branches, label, one) {
    const x = ["real part", "1"], y = ["imaginary part", "1"], all = new Interval(-frame, frame),
          out = ricochet.view(x, y, ricochet.valueAxis(x, all), ricochet.valueAxis(y, all));
    ricochet.draw(
        out, circle, {x: "re", y: "im"}, {...ricochet.line("unit circle", ricochet.faint, 1.2), silent: true});
    const {exact, count} = ricochet.format, parameter = branches.column(one.id, "parameter"),
                  unstable = branches.column(one.id, "unstable"), rows = [];
    let outside = 0;
    for (let i = 0; i < branches.size(one.id); ++i) {
      if (!Number.isFinite(unstable[i])) continue;
      for (const {re, im} of branches.multipliers(one.id, i)) {
        if (Math.abs(re) > frame || Math.abs(im) > frame) {
          ++outside;
          continue;
        }
        rows.push({
          case: one.id,
          row: i,
          re,
          im,
          orbit: unstable[i] > 0 ? "unstable orbit" : "stable orbit",
          text: branches.branch(one.id, i).name + " at " + exact(parameter[i])
        });
      }
    }
    for (const [name, colour] of Object.entries(looks))
      ricochet.draw(
          out, rows, {x: "re", y: "im"}, {...ricochet.dot(name, colour, "circle", 3.5), opacity: 0.55}, {orbit: name});
    const line = halfStep(branches, one.id);
    if (line.length)
      ricochet.draw(out, line, {x: "re", y: "im"}, {...ricochet.line(lineName, lineColour, 1), silent: true, z: 3});
    if (outside) out.notes.push(count(outside, "multiplier lies", "multipliers lie") + " outside this frame.");
    // A square frame: the circle is round.
    Object.assign(out.frames[0], {width: side, height: side});
    return {title: label || "all cases", cases: [one], height: side + 58, views: [out], notes: []};
  }

  ricochet.figure("multipliers", (data) => {
    if (!data.page.branches) return [];
    const branches = new ricochet.Branches(data),
          methods = branches.methods()
                        .map(({label, cases}) => ({label, one: cases[cases.length - 1]}))
                        .filter(({one}) => branches.of(one.id).multipliers > 0);
    if (!methods.length) return [];
    const lined = methods.some(({one}) => branches.column(one.id, "half").length > 0);
    return [{
      id: "multipliers",
      title: "Multipliers of the orbits",
      views: ["plane"],
      charts: methods.map(({label, one}) => chart(branches, label, one)),
      legend: [{name: "unit circle", colour: ricochet.faint, dash: "", symbol: ""}].concat(
          Object.entries(looks).map(([name, colour]) => ricochet.swatch(name, colour, "circle")),
          lined ? [{name: lineName, colour: lineColour, dash: "", symbol: ""}] : []),
      caption: "Multipliers of the step's own map, as its contact sets are, along the branches of each method at its " +
          "finest; of half a period where the orbit is symmetric." +
          (lined ?
               " They jump where a contact set changes, and flicker across the circle. Line: the real one nearest −1 " +
                   "and the pair nearest the circle by the half-step rule, from a modulus of ½ on." :
               ""),
    }];
  });
}
