#include "runners/workers/crash_record.hpp"

#include <sstream>

namespace ricochet {

std::optional<CrashRecord> parse_crash_record(const std::string& text) {
  std::istringstream stream(text);
  CrashRecord record;
  for (std::string line; std::getline(stream, line);) {
    const std::size_t at = line.find('\t');
    if (at == std::string::npos) continue;
    const std::string key = line.substr(0, at), value = line.substr(at + 1);
    if (key == "plugin") record.plugin = value;
    if (key == "function") record.function = value;
    if (key == "ended") record.ended = value;
  }
  // "ended" comes last: a record without it was cut short.
  if (record.ended.empty()) return std::nullopt;
  return record;
}

}  // namespace ricochet
