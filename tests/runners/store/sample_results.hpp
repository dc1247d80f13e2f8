#pragma once
#include <limits>
#include <ricochet/contract/said_format.hpp>

#include "runners/store/record.hpp"

/// Two cases with everything a store can hold, awkward texts included.
inline ricochet::StudyResults sample_results() {
  ricochet::StudyResults results;
  results.name = "sample";
  results.question = "Is \"quoting\" right, and µ too?";
  results.kind = "trajectory";
  results.study = {{"name", "sample"}, {"step", {1e-4, 1e-5}}};
  results.columns = {"mass", "mass.velocity", "step"};
  results.expected_cases = 2;

  ricochet::CaseRecord done;
  done.id = "c0123456789";
  done.axes = {{"mass", "singular"}, {"mass.velocity", "P1"}, {"step", 1e-5}};
  done.status = ricochet::Status::done;
  done.steps = 5000;
  done.setup_seconds = 0.125;
  done.run_seconds = 0.1;  // no exact binary form: must come back as the same double
  done.measures = {{"energy_start", 1.0 / 3.0}, {"impacts", 14}};
  done.left_out = {{"load", "the load is 0"}};
  done.notes = {"a note, with a comma"};
  done.operator_name = "band";
  done.curve.names = {"t", "energy"};
  done.curve.columns = {{0, 0.1, 0.2}, {1e-300, -0.0, 3.612908}};

  ricochet::NumberTable points{"points",
                               ricochet::named_columns({"parameter", "start", "tip_displacement"}),
                               {{0.07, 0.08, 0.08}, {1, 0, 7}, {1e-300, std::numeric_limits<double>::quiet_NaN(), 0.1}},
                               {{"start", {"rest", "a, b"}}}};
  ricochet::NumberTable portraits{"portraits", ricochet::named_columns({"time"}), {{0.5}}, {}, false};
  ricochet::NumberTable none{"impacts", ricochet::named_columns({"parameter", "speed"}), {{}, {}}, {}};
  done.numbers = {points, portraits, none};

  ricochet::CaseRecord refused;
  refused.id = "cabcdefabcd";
  refused.axes = {{"mass", "lumped"}, {"step", 1e-4}};
  refused.status = ricochet::Status::refused;
  refused.reasons = {ricochet::said("β = {} leaves S \"singular\",\nuse β ≥ 1/{}", 0, 4)};
  results.cases = {done, refused};
  results.environment.entries = {{"program", "ricochet"}, {"cores", "2"}};
  return results;
}
