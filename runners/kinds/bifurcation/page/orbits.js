// What the page knows of the orbits of each case, and how it says it.
{
  const finite = (value) => typeof value === "number" && Number.isFinite(value);

  class Orbits {
    constructor(data) {
      const {page} = data;
      Object.assign(
          this, {data, parameter: page.orbits.parameter, groups: page.orbits.groups, kinds: page.orbits.kinds});
      this.cases = data.view.all.filter((one) => page.orbits.cases[one.id]);
    }
    // Columns of `values`, and by orbit its group of regimes, its kind of start and the interval of the parameter that
    // it stands for.
    of(id) { return this.data.page.orbits.cases[id]; }
    label(id) { return this.data.view.label(this.data.byId.get(id)); }
    cell(id, name, o) {
      const column = this.of(id).columns[name];
      return column ? column[o] : null;
    }
    number(id, name, o) {
      const value = this.cell(id, name, o);
      return finite(value) ? value : null;
    }
    block(id, name) { return this.data.block(id + "/" + name); }
    // Orbits of a case with a group and a kind of start; undefined stands for any.
    chosen(id, group, kind) {
      const one = this.of(id), out = [];
      for (let o = 0; o < one.group.length; ++o)
        if ((group === undefined || one.group[o] === group) && (kind === undefined || one.kind[o] === kind))
          out.push(o);
      return out;
    }
    // Index into `kinds`: random states share the last one.
    kindOfStart(start) {
      const known = ["rest", "state", "up", "down"].indexOf(start);
      return known < 0 ? this.kinds.length - 1 : known;
    }
    // Starts of a case: rest, state, up, down, then random states by their number.
    starts(id) {
      const one = this.of(id), kinds = new Map(one.columns.start.map((start, o) => [start, one.kind[o]])),
            number = (start) => Number((/-(\d+)/.exec(start) || [0, 0])[1]);
      return Array.from(kinds.keys()).sort((a, b) => kinds.get(a) - kinds.get(b) || number(a) - number(b));
    }
    // Section points of a case's orbits as pairs (parameter, displacement), with the orbit of each.
    points(id, group, kind) {
      const {parameter} = this.of(id).columns, wanted = new Set(this.chosen(id, group, kind)),
            orbit = this.block(id, "points/orbit") || [], u = this.block(id, "points/u");
      const values = [], orbits = [];
      for (let i = 0; i < orbit.length; ++i) {
        if (!wanted.has(orbit[i])) continue;
        values.push(parameter[orbit[i]], u[i]);
        orbits.push(orbit[i]);
      }
      return {values, orbits};
    }
    // Columns of `values` for the orbits that have them all, as pairs or triples (parameter, …).
    columns(id, group, kind, names) {
      const orbits =
          this.chosen(id, group, kind).filter((o) => names.every((name) => this.number(id, name, o) !== null));
      return {
        values: orbits.flatMap((o) => [this.cell(id, "parameter", o), ...names.map((name) => this.cell(id, name, o))]),
        orbits
      };
    }

    regime(id, o) {
      const status = this.cell(id, "status", o);
      if (status && status !== "done") return status;
      const name = this.cell(id, "class", o) || "undecided", period = this.cell(id, "period", o);
      if (!period) return name;
      const chatter = name === "chattering" ? " with chatter" : "";
      return name === "periodic" || chatter ? "period " + period + chatter : name;
    }
    // "0.1234 (0.12 to 0.13) 1/s"; "" where there is none.
    interval(id, name, o) {
      const {shown} = ricochet.format, value = this.number(id, name, o), low = this.number(id, name + "_low", o),
            high = this.number(id, name + "_high", o);
      if (value === null) return "";
      return shown(value, 4) +
          (low !== null && high !== null ? " (" + shown(low, 4) + " to " + shown(high, 4) + ")" : "") + " 1/s";
    }
    // The hover text of an orbit, with the value that is pointed at.
    words(id, o, quantity, value) {
      const {escape, shown, unit} = ricochet.format,
                            line = (name, text) =>
                                '<div class="tip-row">' + escape(name) + "<b>" + escape(text) + "</b></div>";
      let out = "<div>" + escape(this.parameter[0]) + " = " + shown(this.of(id).columns.parameter[o], 9) +
          escape(unit(this.parameter)) + "</div>";
      if (this.label(id)) out += '<div class="fine">' + escape(this.label(id)) + "</div>";
      out += line(this.regime(id, o), "start " + this.cell(id, "start", o));
      if (value !== undefined) out += line(quantity[0], shown(value, 8) + unit(quantity));
      if (this.interval(id, "exponent_1", o)) out += line("exponent", this.interval(id, "exponent_1", o));
      return out;
    }
  }

  ricochet.Orbits = Orbits;
  ricochet.manyOrbits = true;
}
