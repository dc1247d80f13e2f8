#include "tests/runners/report/browser/driven.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

namespace ricochet::browser {

namespace fs = std::filesystem;

std::string report_of(const std::string& folder, const std::string& kind) {
  static std::map<std::string, std::string> written;
  std::string& file = written[folder + "/" + kind];
  if (!file.empty()) return file;
  const fs::path out = fs::path(RICOCHET_BINARY_DIR) / "browser" / folder / kind;
  fs::remove_all(out);
  fs::create_directories(out.parent_path());
  const std::string command = std::string(RICOCHET_COMMAND) +
                              " run '" RICOCHET_SOURCE_DIR "/tests/runners/report/studies/" + kind + ".json' --out '" +
                              out.string() + "' >'" + out.string() + ".txt' 2>&1";
  INFO(command);
  REQUIRE(std::system(command.c_str()) != -1);
  REQUIRE(fs::exists(out / "report.html"));
  return file = (out / "report.html").string();
}

nlohmann::json driven(const std::string& folder, const nlohmann::json& steps) {
  const fs::path here = fs::path(RICOCHET_BINARY_DIR) / "browser" / folder;
  fs::create_directories(here);
  fs::remove(here / "answers.json");
  std::ofstream(here / "steps.json") << steps;
  const std::string command = "timeout 500 node '" RICOCHET_SOURCE_DIR "/tests/runners/report/browser/drive.js' '" +
                              (here / "steps.json").string() + "' '" + (here / "answers.json").string() + "'";
  INFO(command);
  REQUIRE(std::system(command.c_str()) == 0);
  std::ifstream file(here / "answers.json");
  nlohmann::json out = nlohmann::json::parse(file);
  for (const auto& [name, answer] : out.items()) {
    INFO(name);
    REQUIRE(answer.at("errors") == nlohmann::json::array());
  }
  return out;
}

}  // namespace ricochet::browser
