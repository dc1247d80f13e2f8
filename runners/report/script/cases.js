// The cases of a study as figures speak of them: which axes vary, short labels, groups, one colour per mass matrix. A
// *role* is a method's name with its parameters: "mass" stands for the columns mass, mass.velocity, …
{
  const {distinct} = ricochet, roles = ["mass", "contact", "friction", "time"];
  // Okabe and Ito 2008: distinct for colour-blind readers.
  const colours = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#444444"];

  // "mass" of "mass.velocity"; the column itself where it belongs to no method.
  const roleOf = (column) => roles.find((role) => column === role || column.startsWith(role + ".")) || column;
  // What a label puts before a value: the last part of the column, nothing for a method's own name.
  function word(column) {
    if (roles.includes(column)) return "";
    return (roleOf(column) !== column ? column.slice(column.lastIndexOf(".") + 1) : column) + " ";
  }
  const textOf = (one, column) => (one.values[column] ? one.values[column].text : "");
  // null where the case has no such number.
  const numberOf = (one, column) => (one.values[column] ? one.values[column].number : null);
  const measureOf = (one, name) => (name in one.measures ? one.measures[name] : null);

  // Whether a reference solved the case, and none of the study's methods.
  const solved = (one) => String(one.id).startsWith("reference");

  class Cases {
    constructor(data) {
      this.data = data;
      this.all = data.cases;
      this.axes = new Map(data.page.axes.map((axis) => [axis.name, axis]));
      this.columns = data.page.axes.map((axis) => axis.name);
      // A case without a value differs from one that has it.
      this.varying =
          data.page.axes
              .filter(
                  (axis) => axis.texts.length + (axis.at.some((at, k) => at < 0 && !solved(this.all[k])) ? 1 : 0) > 1)
              .map((axis) => axis.name);
      this.masses = distinct(this.all.map((one) => this.massLabel(one)));
    }
    varies(column) { return this.varying.includes(column); }
    values(column) { return this.axes.has(column) ? this.axes.get(column).texts : []; }
    unit(column) { return this.axes.has(column) ? this.axes.get(column).unit : ""; }
    varyingWithout(excluded) {
      return this.varying.filter((column) => !excluded.includes(column) && !excluded.includes(roleOf(column)));
    }

    // "singular, velocity P1 · beta 0.25": only what varies is said.
    label(one, columns = this.varying) {
      if (solved(one)) return one.id;
      let out = "", previous = "";
      for (const column of columns) {
        const value = textOf(one, column), role = roleOf(column), unit = this.unit(column);
        if (this.values(column).length < 2 || value === "") continue;
        out += (out === "" ? "" : role === previous ? ", " : " · ") + word(column) + value + (unit ? " " + unit : "");
        previous = role;
      }
      return out;
    }
    // The mass matrix with every parameter that varies.
    massLabel(one) {
      const more = this.columns.filter(
          (column) => column !== "mass" && roleOf(column) === "mass" && this.values(column).length > 1 &&
              textOf(one, column) !== "");
      return textOf(one, "mass") + more.map((column) => ", " + word(column) + textOf(one, column)).join("");
    }
    colour(one) { return colours[this.masses.indexOf(this.massLabel(one)) % colours.length]; }

    // Groups by the values of columns, in order of appearance, labelled by them.
    group(cases, columns) {
      // The place of a value among those of its column tells as much as its text, and costs less.
      const places = columns.filter((column) => this.axes.has(column)).map((column) => this.axes.get(column).at),
            groups = new Map();
      for (const one of cases) {
        let key = solved(one) ? one.id : "";
        for (const at of places) key += at[one.index] + ",";
        const known = groups.get(key);
        if (known) known.push(one);
        else groups.set(key, [one]);
      }
      return Array.from(groups.values(), (own) => ({label: this.label(own[0], columns), cases: own}));
    }
    // What sets cases apart from others: "all 24 cases", "12 of 24 cases (mass singular)".
    describe(cases, among) {
      if (cases.length === among.length) return among.length === 1 ? "the one case" : "all " + among.length + " cases";
      const within = (some, column) => distinct(some.map((one) => textOf(one, column)).filter(Boolean));
      const what = this.varying.map((column) => [column, within(cases, column)])
                       .filter(([column, inside]) => inside.length && inside.length !== within(among, column).length);
      return cases.length + " of " + among.length + " cases" +
          (what.length ? " (" + what.map(([column, inside]) => column + " " + inside.join(", ")).join("; ") + ")" : "");
    }
    // "⊘ refused, step 1e-6 s: why", cases with the same reason put together.
    outcomeNotes(cases, columns) {
      const groups = ricochet.groupBy(cases.filter((one) => one.status !== "done"), (one) => [one.status, one.reason]);
      return Array.from(groups.values(), (group) => {
        const who =
            group.length > 2 ? this.describe(group, cases) : group.map((one) => this.label(one, columns)).join("; ");
        const {status, reason} = group[0];
        return ricochet.format.mark(status) + " " + status + (who ? ", " + who : "") + (reason ? ": " + reason : "");
      });
    }
  }

  Object.assign(ricochet, {Cases, roles, roleOf, textOf, numberOf, measureOf});
}
