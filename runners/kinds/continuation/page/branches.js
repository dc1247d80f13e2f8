// The branches of each case as figures read them: columns of equal length, and which rows belong together.
{
  const flickerArc = 0.003;  // m: raw crossings this near are one group
  const refinements = ["elements", "modes", "steps_per_period", "step"];
  const kinds = {
    fold: ["fold", "diamond", 11],
    symmetry: ["loss of symmetry", "triangle", 11],
    flip: ["flip", "rect", 9],
    torus: ["torus", "roundRect", 10],
    "first contact": ["first contact", "circle", 10],
    "lift-off": ["lift-off", "circle", 10],
    contact: ["change of contact", "circle", 6],
    mark: ["mark", "arrow", 9],
    end: ["end", "rect", 5],
  };

  class Branches {
    constructor(data) {
      const {page, view} = data;
      Object.assign(this, {
        data,
        view,
        parameter: page.branches.parameter,
        said: [page.branches.said, page.branches.portraits].filter(Boolean).join(" "),
        beneath: page.branches.beneath
      });
      this.known = new Map();
      this.shaky = new Map();
      this.cases = view.all.filter((one) => page.branches.cases[one.id]);
      this.methodColumns = view.varyingWithout(refinements);
      this.refined = view.varying.filter((column) => refinements.includes(column));
      this.special = data.rowsBy("special_points", ["case"]);
    }
    of(id) { return this.data.page.branches.cases[id]; }
    column(id, name) { return this.data.block(id + "/branch/" + name) || []; }
    size(id) { return this.column(id, "of").length; }
    branch(id, row) { return this.of(id).branches[this.column(id, "of")[row]]; }
    // Cases of one method, the finest last.
    methods() {
      const finer = (a, b) =>
          this.refined.map((column) => (ricochet.numberOf(a, column) || 0) - (ricochet.numberOf(b, column) || 0))
              .find(Boolean) ||
          0;
      return this.view.group(this.cases, this.methodColumns)
          .map((group) => ({label: group.label, cases: group.cases.slice().sort(finer)}));
    }
    label(one) { return this.view.label(one) || "the one case"; }
    methodLabel(one) { return this.view.label(one, this.methodColumns) || "the one method"; }
    refinedLabel(one) { return this.view.label(one, this.refined) || "the one case"; }
    kind(row) {
      if (row.kind !== "contact") return row.kind;
      if (row.runs_before === 0 || row.runs_after === 0) return "first contact";
      return row.held_before === row.held_after ? row.kind : "lift-off";
    }
    kindWords(kind) { return kinds[kind] || [kind, "circle", 7]; }
    points(one) {
      return this.special(one.id).filter((row) => row.parameter !== null && row.tip_displacement !== null);
    }
    // Columns of the rows of one look, "stable", "unstable" or "flickering": where that changes both have the row, and
    // where they end is a gap.
    curve(id, look) {
      const of = this.column(id, "of"), counts = this.column(id, "unstable"), parameter = this.column(id, "parameter"),
            tip = this.column(id, "tip"), out = {parameter: [], tip: [], row: []};
      const shaky = this.flickering(id);
      const looks = (i) => shaky[i] ? "flickering" : counts[i] > 0 ? "unstable" : "stable";
      const is = (i) => Number.isFinite(counts[i]) && looks(i) === look;
      const put = (i) => {
        out.parameter.push(i < 0 ? NaN : parameter[i]);
        out.tip.push(i < 0 ? NaN : tip[i]);
        out.row.push(i);
      };
      for (let i = 0; i + 1 < of.length; ++i) {
        // Between two rows the curve looks as the second does, so that it changes at a point.
        if (of[i] !== of[i + 1] || !is(i + 1)) continue;
        const goes = i > 0 && of[i - 1] === of[i] && is(i);
        if (!goes) {
          if (out.tip.length) put(-1);
          put(i);
        }
        put(i + 1);
      }
      return out;
    }
    // What the rows of cases reach.
    range(cases, name) {
      const out = new ricochet.Interval();
      for (const one of cases)
        for (const value of this.column(one.id, name)) out.include(value);
      return out;
    }
    multipliers(id, row) {
      return Array
          .from(
              {length: this.of(id).multipliers},
              (_, m) => ({re: this.column(id, "re" + (m + 1))[row], im: this.column(id, "im" + (m + 1))[row]}))
          .filter(({re, im}) => Number.isFinite(re) && Number.isFinite(im));
    }
    // Those nearest the circle by the half-step rule: the real one, and the pair.
    smooth(id, row) {
      const half = this.column(id, "half")[row], re = this.column(id, "half_re")[row],
            im = this.column(id, "half_im")[row];
      return [
        ...(Number.isFinite(half) ? [{re: half, im: 0}] : []), ...(Number.isFinite(re) ? [{re, im}, {re, im: -im}] : [])
      ];
    }
    // Whether the film that a case keeps is of this orbit.
    filmed(id, name, arc) {
      return ((this.data.page.snapshots || {}).cases || {})[id]?.of === name + " at an arc of " + arc + " m";
    }
    block(id, name) { return this.data.block(id + "/orbit/" + name) || []; }
    // Whether the page carries the portrait of a row.
    portrayed(id) {
      if (!this.known.has(id)) this.known.set(id, new Map(Array.from(this.block(id, "row"), (row, k) => [row, k])));
      return this.known.get(id);
    }
    // One period of an orbit, closed, over its phase in forcing periods. The second half of an orbit that is its own
    // image is minus the first.
    portrait(id, row) {
      const k = this.portrayed(id).get(row);
      if (k === undefined) return null;
      const first = this.block(id, "first"), all = this.block(id, "u"), {period, symmetric} = this.branch(id, row),
            part = (name) =>
                Array.from(this.block(id, name).slice(first[k], k + 1 < first.length ? first[k + 1] : all.length));
      const whole = (values) => {
        const out = symmetric ? values.concat(values.map((value) => -value)) : values;
        return out.concat(out.slice(0, 1));
      }, u = whole(part("u")), v = whole(part("v"));
      const runs = Array.from(this.block(id, "run/row"))
                       .map((of, i) => ({of, i}))
                       .filter(({of}) => of === row)
                       .map(({i}) => Object.fromEntries([
                         "x", "upper", "bound", "begin", "length"
                       ].map((name) => [name, this.block(id, "run/" + name)[i]])));
      return {
        u,
        v,
        phase: u.map((_, i) => (period * i) / (u.length - 1)),
        period,
        lower: this.block(id, "lower")[k],
        upper: this.block(id, "upper")[k],
        runs
      };
    }
    // Rows at which multipliers cross the circle again and again. Some lie between two changes of stability less than 3
    // mm of arc apart. The others lie around a special point with several crossings, in its interval.
    flickering(id) {
      if (this.shaky.has(id)) return this.shaky.get(id);
      const of = this.column(id, "of"), parameter = this.column(id, "parameter"), arc = this.column(id, "arc"),
            counts = this.column(id, "unstable"), out = new Uint8Array(of.length);
      let last = -1;  // row behind the last change
      for (let i = 1; i < of.length; ++i) {
        if (of[i] !== of[i - 1]) last = -1;
        else if ((counts[i] > 0) !== (counts[i - 1] > 0)) {
          if (last > 0 && arc[i - 1] - arc[last - 1] < flickerArc) out.fill(1, last, i);
          last = i;
        }
      }
      for (const point of this.special(id)) {
        if (!["symmetry", "flip", "torus"].includes(point.kind) || !(point.crossings > 1)) continue;
        const at = this.rowOf(id, point),
              inside = (i) => of[i] === of[at] && parameter[i] >= point.low && parameter[i] <= point.high;
        for (const step of [-1, 1])
          for (let i = at; at >= 0 && inside(i); i += step) out[i] = 1;
      }
      this.shaky.set(id, out);
      return out;
    }
    // The row that a special point is; −1 where it is not drawn.
    rowOf(id, {branch, point}) {
      const of = this.column(id, "of"), own = this.of(id).branches.findIndex((one) => one.name === branch),
            points = this.column(id, "point");
      return of.findIndex((k, i) => k === own && points[i] === point);
    }
  }

  ricochet.Branches = Branches;
}
