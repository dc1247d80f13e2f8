// The tables of stability as figures read them: cells and limits of a case by its contact state.
ricochet.stability = (data) => {
  const contactOf = (row) => row.closed ? "closed" : "open";
  const cells = new Map(), key = (id, contact) => id + "\u001f" + contact, steps = new ricochet.Interval();
  for (const row of data.rows("stability_cells")) {
    if (!cells.has(key(row.case, contactOf(row)))) cells.set(key(row.case, contactOf(row)), []);
    cells.get(key(row.case, contactOf(row))).push(row);
  }
  const limits = new Map(data.rows("step_limits").map((row) => [key(row.case, contactOf(row)), row]));
  const out = {
    steps,
    cells: (one, contact) => cells.get(key(one.id, contact)) || [],
    limits: (one, contact) => limits.get(key(one.id, contact)),
    // Open ranges do not depend on the contact law: of cases that differ in it alone one stands for all.
    cases: (contact) => data.view.all.filter((one) => { const row = limits.get(key(one.id, contact)); return row && row.counted; }),
    disagreements: (one, contact) => data.rows("stability_disagreements").filter((row) => row.case === one.id && contactOf(row) === contact),
  };
  for (const contact of ["open", "closed"]) for (const one of out.cases(contact)) steps.include(...out.cells(one, contact).map((cell) => cell.step));
  return out;
};
