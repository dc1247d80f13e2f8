// The tables of stability as figures read them: rows of a case by its contact state.
ricochet.stability = (data) => {
  const rows = (name) => {
    const found = data.rowsBy(name, ["case", "closed"]);
    return (one, contact) => found(one.id, contact === "closed");
  };
  const cells = rows("stability_cells"), limits = rows("step_limits"), steps = new ricochet.Interval();
  // Open ranges do not depend on the contact law: of cases that differ in it alone one stands for all.
  const cases = (contact) => data.view.all.filter((one) => limits(one, contact).some((row) => row.counted));
  for (const contact of ["open", "closed"])
    for (const one of cases(contact)) steps.include(...cells(one, contact).map((cell) => cell.step));
  const limit = (contact, column) => ({
    view: "largest step, " + contact + ", " + (column === "expected" ? "predicted" : column),
    quantity: ["largest step", "s"],
    of: (one) => {
      const [row] = limits(one, contact);
      return row ? row[column] : null;
    }
  });
  const measured = {
    key: "limits",
    along: "",
    values: ["closed", "open"].flatMap((contact) => ["expected", "observed"].map((column) => limit(contact, column)))
  };
  return {
    measured,
    steps,
    cells,
    cases,
    limits: (one, contact) => limits(one, contact)[0],
    disagreements: rows("stability_disagreements")
  };
};
