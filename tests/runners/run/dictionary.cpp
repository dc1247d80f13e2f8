#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <ricochet/loader/catalogue.hpp>
#include <set>

#include "runners/run/run_study.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/study/load_study.hpp"
#include "tests/places.hpp"
#include "tests/runners/scratch_folder.hpp"

using namespace ricochet;

namespace {

/// Fields of one line of CSV; a quoted field may hold line breaks, which are read on.
std::vector<std::string> read_line(std::istream& in) {
  std::vector<std::string> fields = {""};
  bool quoted = false;
  for (char c = 0; in.get(c);) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      fields.emplace_back();
    else if (c == '\n' && !quoted)
      return fields;
    else
      fields.back() += c;
  }
  return {};
}

/// The columns of every table of a folder, curves as one.
std::map<std::string, std::set<std::string>> tables_in(const std::filesystem::path& folder) {
  std::map<std::string, std::set<std::string>> tables;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    const bool curve = entry.path().parent_path().filename() == "curves";
    std::ifstream file(entry.path());
    const std::vector<std::string> head = read_line(file);
    std::set<std::string>& columns = tables[curve ? "curves" : entry.path().stem().string()];
    if (!curve) CHECK(std::set<std::string>(head.begin(), head.end()).size() == head.size());
    columns.insert(head.begin(), head.end());
  }
  return tables;
}

/// Every column of every table has its line with a meaning, every table a line on its rows, and there is no other line.
void check_dictionary(const std::filesystem::path& folder) {
  INFO(folder);
  std::ifstream file(folder / "dictionary.csv");
  CHECK(read_line(file) == std::vector<std::string>{"table", "column", "unit", "meaning"});
  std::map<std::string, std::set<std::string>> listed;
  std::set<std::string> about;
  for (auto line = read_line(file); line.size() == 4; line = read_line(file)) {
    INFO(line[0] << "." << line[1]);
    CHECK(line[3].size() > 3);
    CHECK(line[3].back() == '.');
    if (line[1].empty())
      CHECK(about.insert(line[0]).second);
    else
      CHECK(listed[line[0]].insert(line[1]).second);
  }
  const auto written = tables_in(folder);
  CHECK(listed == written);
  for (const auto& [table, columns] : written) CHECK(about.count(table) == 1);
}

const char* beam = R"(
  "scene": {"structure": {"type": "beam", "length": 1, "section": {"type": "given", "EI": 1, "rhoS": 1},
                          "damping": {"stiffness": 1e-3}},
            "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"},
            "initial": {"displacement": "0.05*x^2", "velocity": "-x"}},
  "mesh": {"elements": 4},
  "methods": {"mass": ["consistent", "lumped"], "contact": "signorini",
              "time": {"name": "newmark-dumont-paoli", "beta": [0.25, 0.5]}},
)";

const char* shaken = R"(
  "scene": {"structure": {"type": "beam", "length": 1.501, "young": 2e11, "density": 8000,
                          "section": {"type": "tube", "outer_diameter": 0.01, "wall": 0.0005},
                          "damping": {"stiffness": 1e-3}},
            "stops": {"lower": -0.1, "upper": 0.1, "at": "tip"},
            "support": {"amplitude": 0.08, "pulsation": 10}},
  "mesh": {"elements": 2},
  "methods": {"mass": "consistent", "contact": "signorini",
              "time": {"name": "newmark-dumont-paoli", "beta": [0.25, 0.5]}},
  "steps_per_period": 200, "transient": {"periods": 4, "at_most": 8}, "keep": 16,
)";

const char* oscillator = R"(
  "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1},
            "stops": {"lower": null, "upper": 0.5},
            "initial": {"displacement": 0, "velocity": 1}},
  "methods": {"mass": "consistent", "contact": "signorini",
              "time": [{"name": "newmark-dumont-paoli", "restitution": 0.5}]},
  "step": [0.02, 0.01, 0.005, 0.0025], "duration": 4, "reference": "exact",
)";

}  // namespace

TEST_CASE("every column of every table that a study of any kind writes is in its dictionary, and nothing else") {
  struct Kind {
    const char *name, *body, *keys;
  };
  const Kind kinds[] = {
      {"trajectory", beam, R"("step": [1e-3, 5e-4], "duration": 0.05, "samples": 10)"},
      {"stability", beam, R"("duration": 0.05, "steps": {"from": 1e-3, "to": 1e-1, "count": 4})"},
      {"convergence", oscillator, R"("errors": ["tip-linf", "energy", "impact-times"])"},
      {"work-precision", oscillator, R"("errors": ["tip-linf"], "repeats": 1)"},
      {"bifurcation", shaken,
       R"("parameter": {"pointer": "/scene/support/amplitude", "values": [0.02, 0.09]}, "exponents": 1)"},
      {"basins", shaken, R"("axes": [{"pointer": "/scene/support/amplitude", "from": 0.02, "to": 0.09, "count": 2},
                                     {"pointer": "/scene/support/pulsation", "from": 9, "to": 10, "count": 2}])"},
  };
  const ScratchFolder folder;
  for (const Kind& kind : kinds) {
    INFO(kind.name);
    static Catalogue catalogue(tests::places().plugins, {}, {});
    Registry registry;
    const std::string text =
        std::string("{\"name\": \"one\", \"kind\": \"") + kind.name + "\"," + kind.body + kind.keys + "}";
    const Study study = parse_study(text, catalogue, registry);
    const std::filesystem::path out = folder / kind.name, tables = folder / (std::string(kind.name) + "-tables");
    run_study(study, catalogue, registry, {out, 2, false});
    REQUIRE(std::filesystem::exists(out / "cases.csv"));
    check_dictionary(out);
    REQUIRE(export_tables(out, tables) == 0);
    for (const char* table : {"left_out", "notes", "environment", "measures"})
      CHECK(std::filesystem::exists(tables / (std::string(table) + ".csv")));
    check_dictionary(tables);
  }
}
