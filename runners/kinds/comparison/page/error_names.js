// What figures of errors share: the units of errors, the grey of what is at or below a floor, the line of the floor.
{
  const grey = "#b3b3b3", floorName = "error floor", floorColour = "#7a7a7a";

  ricochet.errors = {
    floorName,
    floorLine: ricochet.line(floorName, floorColour, 1.2, ricochet.dash(2)),
    floorEntry: {name: floorName, colour: floorColour, dash: ricochet.svgDash(2)},
    // Points at or below the floor are grey; its line has the curve's colour.
    curve: (curve) => ({...ricochet.curve(curve), colour: (row) => (row.value <= row.floor ? grey : curve.colour)}),
    // A kind of error with its unit; "1" where the unit depends on the structure.
    quantity: (error) =>
        ["error " + error,
         {"tip-linf": "m", "tip-l2": "m", energy: "J", "impact-times": "s", impulse: "N s"}[error] || "1"],
    // What a map of cases shows: each kind of error, as `rowOf` finds it.
    measured: (kinds, rowOf) => kinds.map(({error}) => ({
                                            view: error,
                                            quantity: ricochet.errors.quantity(error),
                                            of: (one) => {
                                              const row = rowOf(one, error);
                                              return row && Number.isFinite(row.value) ? row.value : null;
                                            }
                                          })),
    // Kinds of errors of a table, in its order.
    kinds: (rows) => ricochet.distinct(rows.map((row) => row.error)),
  };
}
