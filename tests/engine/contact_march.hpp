#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/measure/contact/impact_recorder.hpp>
#include <ricochet/measure/contact/stop_contacts.hpp>
#include <ricochet/measure/contact/tangent_watch.hpp>
#include <ricochet/measure/energy/energy_audit.hpp>

#include "tests/marching.hpp"

namespace ricochet::testing {

/// A scene of one lane, marched to its end, and what its stops saw.
struct ContactMarch {
  Marcher made;
  ImpactRecorder recorder;
  StopContacts contacts;
  TangentWatch tangents;
  EnergyAudit audit;
  double wear;  // J

  ContactMarch(const SceneSpec& scene, int elements, const Methods& methods, double h, double duration,
               const CompileOptions& options = {})
      : made(marcher(scene, elements, methods, h, options)),
        recorder(made),
        contacts(made, recorder),
        tangents(made, {0, duration}),
        audit(made) {
    contacts.tell(&tangents);
    const Observers all{&tangents, &recorder, &audit};
    made.start(all);
    made.march(std::llround(duration / h) - made.step(), all);
    REQUIRE(made.status(0).running);
    tangents.finish(made);
    recorder.finish(made);
    contacts.finish();
    wear = tangents.any() ? duration * tangents.power(0) : 0;
  }
};

}  // namespace ricochet::testing
