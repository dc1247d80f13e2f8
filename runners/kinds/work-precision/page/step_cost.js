ricochet.figure("step-cost", (data) => ricochet.workAgainstError(data, {
  id: "step-cost",
  title: "Time per step against error",
  quantity: ["time per step", "µs"],
  column: "microseconds",
  spread: false,
  front: null,
  caption: "",
}));
