ricochet.figure("energy", (data) => ricochet.overTime(data, {
  id: "energy",
  title: "Energy against time",
  column: "energy",
  quantity: ["energy E", "J"],
  scales: ["value", "ratio", "change"],
  fromZero: true,
  withStops: false,
  measured: {key: "final-energy", values: ricochet.energyValues(data)},
  caption: "Mechanical energy ½vᵀMv + ½qᵀKq plus that stored in compliant contacts, at the time where each scheme's " +
      "velocity stands (the end of a step, or its middle).",
}));
