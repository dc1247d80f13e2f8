ricochet.figure("tip", (data) => ricochet.overTime(data, {
  id: "tip",
  title: "Tip displacement",
  column: "tip_displacement",
  quantity: ["tip displacement", "m"],
  scales: ["value"],
  fromZero: false,
  withStops: true,
  measured: {
    values: [{
      view: "at the end (m)",
      quantity: ["tip displacement at the end", "m"],
      of: (one) => ricochet.measureOf(one, "tip_displacement_end")
    }]
  },
  caption: "Displacement of the tip: absolute, unless the frame of the scene is that of the supports.",
}));
