// What the energy ends at, against every axis.
ricochet.energyValues = (data) => {
  const changes = data.rowsBy("energy_changes", ["case"]),
        changeOf = (one) => changes(one.id)[0] || {change: null, gained: false};
  const values = [
    {
      view: "|E(T) / E_in − 1|",
      quantity: ["|E(T) / E_in − 1|", "1"],
      logarithmic: true,
      of: (one) => changeOf(one).change,
      hollow: (one) => changeOf(one).gained
    },
    {
      view: "E(T) / E_in",
      quantity: ["E(T) / E_in", "1"],
      logarithmic: false,
      of: (one) => ricochet.measureOf(one, "energy_left")
    },
    {
      view: "E(T) (J)",
      quantity: ["energy at the end E(T)", "J"],
      logarithmic: true,
      of: (one) => ricochet.measureOf(one, "energy_end")
    },
  ];
  // Where damping or loads work, the change from the start says little: the ratio comes first.
  if (data.rows("energy_changes").some((row) => !row.conservative)) values.unshift(...values.splice(1, 1));
  return values;
};
ricochet.figure("final-energy", (data) => ricochet.alongAxes(data, {
  id: "final-energy",
  title: "Energy at the end",
  values: ricochet.energyValues(data),
  caption:
      "E_in: the energy brought in, that of the start and what loads brought in beyond what they took. One colour " +
      "per mass matrix. Where the modulus of the change is shown, full marks lost energy and hollow marks gained it.",
}));
