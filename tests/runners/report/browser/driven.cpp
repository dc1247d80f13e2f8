#include "tests/runners/report/browser/driven.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/places.hpp"

namespace ricochet::browser {

namespace fs = std::filesystem;

namespace {

/// When the newest of what makes a report was built or written: the command, its methods, the study.
fs::file_time_type newest_source(const fs::path& study) {
  auto newest = std::max(fs::last_write_time(study), fs::last_write_time(tests::places().command));
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(tests::places().build) / "lib"))
    if (entry.is_regular_file()) newest = std::max(newest, entry.last_write_time());
  return newest;
}

/// Held by one process at a time.
class Lock {
 public:
  explicit Lock(const fs::path& file) : file_(open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
    REQUIRE(file_ >= 0);
    REQUIRE(flock(file_, LOCK_EX) == 0);
  }
  ~Lock() { close(file_); }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;

 private:
  int file_;
};

}  // namespace

std::string report_of(const std::string& folder, const std::string& kind) {
  const fs::path out = fs::path(tests::places().build) / "browser" / folder / kind, report = out / "report.html";
  const fs::path study = tests::places().source + "/tests/runners/report/studies/" + kind + ".json";
  fs::create_directories(out.parent_path());
  const Lock lock(out.string() + ".lock");
  const fs::path whole = out.string() + ".whole";  // written after a run that was not stopped
  if (fs::exists(report) && fs::exists(whole) && fs::last_write_time(whole) > newest_source(study))
    return report.string();
  fs::remove(whole);
  fs::remove_all(out);
  const std::string command = tests::places().command + " run '" + study.string() + "' --out '" + out.string() +
                              "' >'" + out.string() + ".txt' 2>&1";
  INFO(command);
  REQUIRE(std::system(command.c_str()) != -1);
  REQUIRE(fs::exists(report));
  std::ofstream(whole).flush();
  return report.string();
}

nlohmann::json driven(const std::string& folder, const nlohmann::json& steps) {
  const fs::path here = fs::path(tests::places().build) / "browser" / folder;
  fs::create_directories(here);
  fs::remove(here / "answers.json");
  std::ofstream(here / "steps.json") << steps;
  const std::string command = "timeout 1500 node '" + tests::places().source +
                              "/tests/runners/report/browser/drive.js' '" + (here / "steps.json").string() + "' '" +
                              (here / "answers.json").string() + "'";
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

std::string words_of(const std::string& command) {
  std::string out;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  REQUIRE(pipe != nullptr);
  char buffer[4096];
  while (const std::size_t count = std::fread(buffer, 1, sizeof buffer, pipe)) out.append(buffer, count);
  REQUIRE(pclose(pipe) == 0);
  return out;
}

}  // namespace ricochet::browser
