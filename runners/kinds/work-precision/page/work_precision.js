ricochet.figure("work-precision", (data) => ricochet.workAgainstError(data, {
  id: "work-precision",
  title: "Run time against error",
  quantity: ["run time", "s"],
  column: "seconds",
  spread: true,
  front: "on_front",
  caption:
      " Each point is one step of its method; left and low is better. The band is the Pareto front of all methods of " +
      "the scene: no case is both faster and more precise. Bars: fastest and slowest repeat.",
}));
