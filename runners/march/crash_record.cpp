#include "runners/march/crash_record.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

namespace ricochet {

std::string CrashRecord::reason() const {
  if (plugin.empty())
    return fmt::format("the program was ended by {} outside of any plugin's function (an earlier run)", ended);
  return fmt::format("plugin {} ended the program by {} in {}() (an earlier run)", plugin, ended, function);
}

std::filesystem::path crash_record_file(const std::filesystem::path& folder) {
  return folder / "crash.txt";
}

std::optional<CrashRecord> parse_crash_record(const std::string& text) {
  std::istringstream stream(text);
  CrashRecord record;
  for (std::string line; std::getline(stream, line);) {
    const std::size_t at = line.find('\t');
    if (at == std::string::npos) continue;
    const std::string key = line.substr(0, at), value = line.substr(at + 1);
    if (key == "case") record.case_id = value;
    if (key == "fingerprint") record.fingerprint = value;
    if (key == "plugin") record.plugin = value;
    if (key == "function") record.function = value;
    if (key == "ended") record.ended = value;
  }
  // "ended" comes last: a record without it was cut short.
  if (record.ended.empty()) return std::nullopt;
  return record;
}

std::optional<CrashRecord> read_crash_record(const std::filesystem::path& folder) {
  std::ostringstream text;
  text << std::ifstream(crash_record_file(folder)).rdbuf();
  return parse_crash_record(text.str());
}

void remove_crash_record(const std::filesystem::path& folder) {
  std::error_code ignored;
  std::filesystem::remove(crash_record_file(folder), ignored);
}

}  // namespace ricochet
