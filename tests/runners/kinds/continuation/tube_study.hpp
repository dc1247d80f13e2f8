#pragma once
#include <atomic>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "runners/kinds/continuation/continuation.hpp"
#include "runners/kinds/continuation/continuation_tables.hpp"
#include "runners/store/record_values.hpp"
#include "runners/study/load_study.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/places.hpp"
#include "tests/refusals.hpp"

/// \file
/// Small studies of kind `continuation`, from their text to what a case of them leaves.
namespace ricochet::testing {

/// The shaken tube on a coarse mesh, stops at its tip; tests change it.
inline Json tube_continuation() {
  return Json::parse(R"({
    "name": "tube", "kind": "continuation",
    "scene": {
      "structure": {"type": "beam", "length": 1.501, "young": 2e11, "density": 8000,
                    "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005},
                    "damping": {"stiffness": 1e-4}},
      "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"},
      "support": {"amplitude": 0.08, "pulsation": 10}
    },
    "mesh": {"elements": 5},
    "methods": {"mass": {"name": "singular", "velocity": "P1"}, "contact": "signorini",
                "time": {"name": "newmark-dumont-paoli", "beta": 0.5}},
    "steps_per_period": 200,
    "parameter": {"pointer": "/scene/support/amplitude", "from": 0.07, "to": 0.09},
    "orbits": [{"at": 0.085, "periods": 100}],
    "switch": null
  })");
}

struct OpenedContinuation {
  Study study;
  const Registry* registry = nullptr;
};

inline OpenedContinuation opened_continuation(const Json& text) {
  static Catalogue catalogue(tests::places().plugins, {}, {});
  static Registry registry;
  OpenedContinuation opened;
  opened.study = parse_study(text.dump(1), catalogue, registry);
  opened.registry = &registry;
  REQUIRE_FALSE(opened.study.cases.empty());
  return opened;
}

/// What the text of a study is refused with.
inline std::string error_of(const Json& text) {
  return input_error([&] { opened_continuation(text); });
}

inline CaseRecord continued(const Json& text, const CaseContext& context = {}) {
  const OpenedContinuation opened = opened_continuation(text);
  const std::atomic<bool> stop{false};
  return run_continuation(opened.study.cases.front(), *opened.registry, context, stop);
}

inline std::string refusal_of(const Json& text) {
  const OpenedContinuation opened = opened_continuation(text);
  return plan_continuation(opened.study.cases.front(), *opened.registry).refusal;
}

inline std::vector<BranchRow> rows_of(const CaseRecord& record) {
  const Table* table = find_table(record.tables, branches_name);
  REQUIRE(table);
  return branch_rows_in(*table);
}

inline std::vector<SpecialRow> points_of(const CaseRecord& record) {
  return special_points_type().read(record.tables);
}

}  // namespace ricochet::testing
