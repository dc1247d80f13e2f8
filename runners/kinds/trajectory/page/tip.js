ricochet.figure("tip", (data) => ricochet.overTime(data, {
  id: "tip", title: "Tip displacement", column: "tip_displacement", quantity: ["tip displacement", "m"], scales: ["value"], fromZero: false, withStops: true,
  caption: "Absolute displacement at the free end, motion of the support included.",
}));
