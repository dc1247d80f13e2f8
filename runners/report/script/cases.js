// The cases of a study as figures speak of them: which axes vary, short labels, groups, one colour per mass matrix. A
// *role* is a method's name with its parameters: "mass" stands for the columns mass, mass.velocity, … What a column and
// a mass matrix are called comes with the page.
{
  const {distinct} = ricochet;
  const axisOf = (column) => ricochet.data.view.axes.get(column);
  // "mass" of "mass.velocity"; the column itself where it belongs to no method.
  const roleOf = (column) => (axisOf(column) || {role: column}).role;
  const isMethod = (column) => ricochet.data.page.roles.includes(roleOf(column));
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
      this.varying = data.page.axes.filter((axis) => axis.varies).map((axis) => axis.name);
      this.masses = data.page.masses;
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
        out += (out === ""            ? "" :
                    role === previous ? ", " :
                                        " · ") +
            this.axes.get(column).word + value + (unit ? " " + unit : "");
        previous = role;
      }
      return out;
    }
    // The mass matrix with every parameter that varies.
    massLabel(one) { return one.mass || ""; }
    colour(one) { return one.colour; }

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

  Object.assign(ricochet, {Cases, roleOf, isMethod, textOf, numberOf, measureOf});
}
