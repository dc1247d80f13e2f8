ricochet.figure("force", (data) => ricochet.overTime(data, {
  id: "force", title: "Contact force", column: "contact_force", quantity: ["contact force", "N"], scales: ["value"], fromZero: true, withStops: false,
  caption: "Sum over the contact points at the sampled instants; a peak between two samples does not show.",
}));
