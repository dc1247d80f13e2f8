ricochet.figure("steps-precision", (data) => ricochet.workAgainstError(data, {
  id: "steps-precision",
  title: "Steps against error",
  quantity: ["steps", "1"],
  column: "steps",
  spread: false,
  front: "on_front_of_steps",
  caption: "",
}));
