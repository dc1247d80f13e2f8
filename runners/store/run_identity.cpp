#include "runners/store/run_identity.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <nlohmann/json.hpp>

namespace ricochet {

std::string RunIdentity::text() const {
  const std::string where =
      job.empty() ? "" : fmt::format(", job {}{}", job, restart > 0 ? fmt::format(" (restart {})", restart) : "");
  return fmt::format("process {} on {}{}, started {}", process, host, where, started);
}

bool RunIdentity::succeeds(const RunIdentity& other) const {
  return !job.empty() && job == other.job && restart > other.restart;
}

std::string RunIdentity::to_json() const {
  using Json = nlohmann::ordered_json;
  return Json{{"host", host}, {"process", process}, {"started", started}, {"job", job}, {"restart", restart}}.dump(
      -1, ' ', false, Json::error_handler_t::replace);
}

RunIdentity RunIdentity::from_json(const std::string& json) {
  RunIdentity found;
  const auto read = nlohmann::ordered_json::parse(json, nullptr, false);
  if (!read.is_object()) return found;
  found.host = read.value("host", found.host);
  found.process = read.value("process", found.process);
  found.started = read.value("started", found.started);
  found.job = read.value("job", found.job);
  found.restart = read.value("restart", found.restart);
  return found;
}

std::string utc_time() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

RunIdentity this_run() {
  RunIdentity run;
  std::array<char, 128> host{};
  run.host = ::gethostname(host.data(), host.size() - 1) == 0 ? host.data() : "?";
  run.process = ::getpid();
  run.started = utc_time();
  if (const char* job = std::getenv("SLURM_JOB_ID")) run.job = job;
  if (const char* restart = std::getenv("SLURM_RESTART_COUNT")) run.restart = std::atoi(restart);
  return run;
}

}  // namespace ricochet
