#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/store/read_status.hpp"
#include "runners/table/plain_text.hpp"

namespace ricochet {
namespace {

// A run writes how far it is every few seconds, and what it has under way is kept as often.
constexpr double silence = 60;  // s

std::string status_text(const std::string& folder, const RunStatus& status) {
  int finished = 0;
  std::string kinds;
  for (const auto& [word, count] : status.rows) {
    finished += count;
    kinds += fmt::format("{}{} {}", kinds.empty() ? ": " : ", ", count, word);
  }
  const std::string part = status.part.whole() ? "" : ", " + status.part.text();
  std::string text = fmt::format("{} ({}, {}{}): {} of {} case{} finished{}\n", folder, status.name, status.kind, part,
                                 finished, status.expected, status.expected == 1 ? "" : "s", kinds);
  const std::string who = status.run ? status.run->text() : "a run";
  if (!status.progress.empty()) {
    text += fmt::format("  {}\n", who);
    text += fmt::format("  {}, {} ago\n", status.progress, duration_text(status.silent));
    if (status.silent > silence)
      text += fmt::format(
          "  it has not written for {}: it has ended, or cannot write; the same command again goes on where it was\n",
          duration_text(status.silent));
  } else if (finished < status.expected) {
    text += fmt::format("  not under way; last {}: the same command again goes on where it was\n", who);
  }
  constexpr std::size_t most = 8;
  std::vector<std::string> running;
  for (const RunStatus::UnderWay& one : status.under_way)
    if (one.stage == "run") running.push_back(fmt::format("{} (since {})", one.id, one.since));
  const std::size_t told = std::min(most, running.size());
  if (told > 0)
    text +=
        fmt::format("  under way: {}{}\n", fmt::join(running.begin(), running.begin() + static_cast<long>(told), ", "),
                    running.size() > told ? fmt::format(" and {} more", running.size() - told) : "");
  return text;
}

}  // namespace

int command_status(const Arguments& arguments, std::ostream& out) {
  for (const std::string& folder : arguments.operands) out << status_text(folder, read_status(folder));
  return exit_done;
}

}  // namespace ricochet
