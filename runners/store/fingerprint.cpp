#include "runners/store/fingerprint.hpp"

#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <ricochet/loader/catalogue.hpp>
#include <sstream>

#include "runners/store/atomic_file.hpp"
#include "runners/study/case_id.hpp"
#include "runners/study/fields.hpp"

namespace ricochet {
namespace {

/// The core library as the loader mapped it; the program itself where the core is linked into it.
std::filesystem::path core_file() {
  std::filesystem::path found = program_file();
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* data) {
        const std::filesystem::path file = info->dlpi_name;
        if (!file.filename().string().starts_with("libricochet-core")) return 0;
        *static_cast<std::filesystem::path*>(data) = file;
        return 1;
      },
      &found);
  return found;
}

// What tells one build of a file from another: read at each start, where a hash of all bytes would cost half of it.
std::string build_of(const std::filesystem::path& file) {
  std::string id;
  try {
    id = build_id(file);
  } catch (const std::runtime_error&) {  // no program of this form
  }
  return id.empty() ? file_hash(file) : id;
}

}  // namespace

std::filesystem::path program_file() {
  const std::filesystem::path self = "/proc/self/exe";
  std::error_code error;
  const std::filesystem::path file = std::filesystem::read_symlink(self, error);
  return file.filename() == "ricochet-mpi" ? file.parent_path() / "ricochet" : self;
}

Json content_of(const MethodChoice& method) {
  Json parameters = Json::object();
  for (const auto& [key, value] : method.parameters.values()) parameters[key] = to_json(value);
  Json json = {{"name", method.name}, {"parameters", std::move(parameters)}};
  if (method.plan) json["plan"] = *method.plan;
  return json;
}

std::string file_hash(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw StoreError(fmt::format("{}: cannot be read: {}", file.string(), std::strerror(errno)));
  // All of it, or an exception: a stream that runs out of memory would keep the beginning.
  std::string content(std::filesystem::file_size(file), '\0');
  if (!stream.read(content.data(), static_cast<std::streamsize>(content.size())))
    throw StoreError(fmt::format("{}: read error", file.string()));
  return content_hash(content);
}

const std::string& program_hash() {
  static const std::string hash = content_hash(build_of(program_file()) + build_of(core_file()));
  return hash;
}

std::string Fingerprints::of(const StudyCase& study_case, const std::vector<std::filesystem::path>& libraries) {
  Json content = {{"id", former_id(study_case.id)},
                  {"kind", kind_},
                  {"program", program_},
                  {"scene", study_case.scene_json},
                  {"mass", content_of(study_case.mass)},
                  {"contact", content_of(study_case.contact)},
                  {"time", content_of(study_case.time)},
                  {"elements", study_case.elements},
                  {"step", study_case.step},
                  {"duration", study_case.duration},
                  {"samples", study_case.samples},
                  {"march", study_case.march}};
  if (!study_case.friction.name.empty()) content["friction"] = content_of(study_case.friction);
  for (const auto& [name, value] : study_case.axes) content["axes"].push_back({name, value});
  if (!study_case.settings.is_null()) content["settings"] = study_case.settings;
  if (study_case.excluded) content["excluded"] = *study_case.excluded;
  for (const auto& library : libraries) {
    if (library.empty()) continue;
    auto known = files_.find(library);
    if (known == files_.end()) known = files_.emplace(library, file_hash(library)).first;
    content["libraries"].push_back(known->second);
  }
  return content_hash(content.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string environment_entry(const Environment& environment, const std::string& name) {
  const auto found = std::find_if(environment.entries.begin(), environment.entries.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  return found == environment.entries.end() ? "" : found->second;
}

std::string without_place(const std::string& name, const std::string& value) {
  const std::size_t open = value.rfind('(');
  return name.starts_with("plugin ") && open != std::string::npos ? value.substr(open) : value;
}

void tell_arithmetics(StudyResults& results) {
  std::map<std::string, int> met;
  for (const CaseRecord& record : results.cases)
    if (!record.arithmetic.empty() && !record.partial && record.status != Status::refused) ++met[record.arithmetic];
  if (met.empty()) return;
  auto& entries = results.environment.entries;
  std::erase_if(entries, [](const auto& entry) { return entry.first.starts_with(kArithmetic); });
  if (met.size() == 1) {
    entries.emplace_back(kArithmetic, met.begin()->first);
    return;
  }
  std::vector<std::string> parts;
  for (const auto& [digest, cases] : met)
    parts.push_back(fmt::format("{} ({} case{})", digest, cases, cases == 1 ? "" : "s"));
  entries.emplace_back(kArithmetic,
                       fmt::format("{} that differ in last digits: {}", met.size(), fmt::join(parts, ", ")));
}

std::string motion_key(const std::string& arithmetic, const std::string& key) {
  return arithmetic.empty() ? key : arithmetic + "/" + key;
}

Environment merge_environments(const Environment& now, const Environment& earlier) {
  const std::string mark = " (earlier cases)";
  Environment merged = now;
  const auto has = [&](const std::pair<std::string, std::string>& entry) {
    return std::find(merged.entries.begin(), merged.entries.end(), entry) != merged.entries.end();
  };
  for (const auto& [name, value] : earlier.entries) {
    const std::pair<std::string, std::string> entry = {name.ends_with(mark) ? name : name + mark, value};
    if (name != kStarted && !has({name, value}) && !has(entry)) merged.entries.push_back(entry);
  }
  return merged;
}

}  // namespace ricochet
