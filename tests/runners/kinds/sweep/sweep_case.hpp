#pragma once
#include <catch2/catch.hpp>
#include <cmath>
#include <ricochet/loader/catalogue.hpp>
#include <ricochet/measure/orbits/recurrence.hpp>
#include <string>
#include <vector>

#include "runners/kinds/bifurcation/bifurcation.hpp"
#include "runners/study/load_study.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"
#include "tests/places.hpp"
#include "tests/runners/kinds/sweep/block_threads.hpp"

/// \file
/// Small studies of kind `bifurcation`, from their text to what a case of them leaves.
namespace ricochet::testing {

/// The shaken beam of the working set on a coarse mesh, its amplitude the parameter; tests change it.
inline Json beam_sweep(const std::vector<double>& values, const Json& start = "rest") {
  Json study = Json::parse(R"({
    "name": "sweep", "kind": "bifurcation",
    "scene": {
      "structure": {"type": "beam", "length": 1.501, "young": 2e11, "density": 8000,
                    "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005},
                    "damping": {"stiffness": 1e-3}},
      "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"},
      "support": {"amplitude": 0.08, "pulsation": 10}
    },
    "mesh": {"elements": 4},
    "methods": {"mass": {"name": "singular", "velocity": "P1"}, "contact": "signorini",
                "time": {"name": "newmark-dumont-paoli", "beta": 0.5}},
    "steps_per_period": 200,
    "transient": {"periods": 20, "at_most": 60},
    "keep": 16,
    "exponents": 0,
    "refine": null
  })");
  study["parameter"] = {{"pointer", "/scene/support/amplitude"}, {"values", values}};
  study["start"] = start.is_array() ? start : Json::array({start});
  return study;
}

/// An oscillator with one stop, m = k = 1, driven by cos ωt of 1 N; the pulsation is the parameter.
inline Json oscillator_sweep(const std::vector<double>& values, double restitution) {
  Json study = Json::parse(R"({
    "name": "oscillator", "kind": "bifurcation",
    "scene": {
      "structure": {"type": "oscillator", "mass": 1, "stiffness": 1, "damping": 0.2,
                    "force": {"amplitude": 1, "pulsation": 2.2}},
      "stops": {"upper": 0.1, "at": "tip"}
    },
    "methods": {"mass": "consistent", "contact": "signorini"},
    "steps_per_period": 400, "start": ["rest"],
    "transient": {"periods": 60, "at_most": 200}, "keep": 20, "exponents": 0, "refine": null
  })");
  study["parameter"] = {{"pointer", "/scene/structure/force/pulsation"}, {"values", values}};
  study["methods"]["time"] = {{"name", "newmark-dumont-paoli"}, {"restitution", restitution}};
  return study;
}

/// The study of a text and the methods that it names.
struct OpenedSweep {
  Study study;
  const Registry* registry = nullptr;
  const StudyCase& first() const { return study.cases.front(); }
};

inline OpenedSweep opened_sweep(const Json& text) {
  static Catalogue catalogue(tests::places().plugins, {}, {});
  static Registry registry;
  OpenedSweep opened;
  opened.study = parse_study(text.dump(1), catalogue, registry);
  opened.registry = &registry;
  REQUIRE_FALSE(opened.study.cases.empty());
  return opened;
}

inline const Table& table_of(const CaseRecord& record, const std::string& name) {
  for (const Table& one : record.tables)
    if (one.name == name) return one;
  throw std::runtime_error("no table " + name);
}

inline const NumberTable& numbers_of(const CaseRecord& record, const std::string& name) {
  for (const NumberTable& one : record.numbers)
    if (one.name == name) return one;
  throw std::runtime_error("no numbers " + name);
}

inline std::vector<Cell> column_of(const Table& table, const std::string& name) {
  const TableReader rows(table);
  const std::size_t column = rows.column(name);
  std::vector<Cell> out;
  for (std::size_t row = 0; row < rows.size(); ++row) out.push_back(rows.cell(row, column));
  return out;
}

inline const std::vector<double>& column_of(const NumberTable& table, const std::string& name) {
  const std::vector<double>* numbers = table.numbers(name);
  if (!numbers) throw std::runtime_error("no column " + name);
  return *numbers;
}

/// A column of the table `values`.
inline std::vector<Cell> of_values(const CaseRecord& record, const std::string& name) {
  return column_of(table_of(record, "values"), name);
}

/// Every table and number of a record as text that tells results apart which differ in one bit.
inline std::string bits_of(const CaseRecord& record) {
  std::string text = word(record.status) + record.reason() + std::to_string(record.steps);
  for (const Table& table : record.tables)
    for (const auto& row : table.rows)
      for (const Cell& cell : row) text += csv_cell(cell) + "\n";
  for (const NumberTable& table : record.numbers)
    for (const auto& column : table.values)
      text.append(reinterpret_cast<const char*>(column.get().data()), column.size() * sizeof(double));
  return text;
}

/// `workers`: 0: the case marches itself.
inline CaseRecord run_sweep(const Json& text, int workers = 0) {
  const OpenedSweep opened = opened_sweep(text);
  BlockThreads blocks(opened.first(), *opened.registry, workers);
  CaseContext context;
  if (workers > 0) context.blocks = &blocks;
  const std::atomic<bool> stop = false;
  return run_bifurcation(opened.first(), *opened.registry, context, stop);
}

/// Whether two settlings have seen the same, bit for bit.
inline bool same_settling(const Settling& a, const Settling& b) {
  return a.scale == b.scale && a.tolerance == b.tolerance && a.longest == b.longest && a.ring == b.ring &&
         a.repeats == b.repeats && a.periods == b.periods;
}

}  // namespace ricochet::testing
