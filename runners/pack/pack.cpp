#include "runners/pack/pack.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <ricochet/contract/errors.hpp>
#include <set>
#include <sstream>

#include "runners/pack/sha256.hpp"
#include "runners/pack/zip_file.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

/// A part: a file, or a text made here.
struct Part {
  std::string name;
  fs::path file;  ///< empty: `text`
  std::string text;
  std::string sum;
  std::uintmax_t size = 0;
};

Part part_of(std::string name, const fs::path& file) {
  return {std::move(name), file, "", file_sha256(file), fs::file_size(file)};
}

Part part_of(std::string name, std::string text) {
  Sha256 sum;
  sum.add(text);
  const std::size_t size = text.size();
  return {std::move(name), {}, std::move(text), sum.digits(), size};
}

std::string dumped(const Json& json) {
  constexpr int indent = 2;
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// What a run left in its folder, locks and what hides left out.
void add_results(const fs::path& folder, std::vector<Part>& parts) {
  for (auto item = fs::recursive_directory_iterator(folder); item != fs::recursive_directory_iterator(); ++item) {
    const fs::path name = item->path().lexically_relative(folder);
    if (name.filename().string().starts_with(".")) {
      item.disable_recursion_pending();
      continue;
    }
    if (item->is_symlink() || (!item->is_directory() && !item->is_regular_file()))
      throw StoreError(fmt::format("{}: is a link or no file; expected what a run writes", item->path().string()));
    if (item->is_directory() || name == "results.lock") continue;
    parts.push_back(part_of((packed::results / name).generic_string(), item->path()));
  }
}

bool names_files(const StudyResults& results) {
  return results.study.contains("files") && results.study["files"].is_object();
}

Json study_part(const StudyResults& results) {
  Json study = results.study;
  study.erase("files");
  return study;
}

const std::string study_name = fmt::format("{}/study.json", packed::study);

/// The study as it runs anywhere: the files that it names lie beside it.
void add_study(const StudyResults& results, std::vector<Part>& parts) {
  if (names_files(results)) {
    const Json& files = results.study["files"];
    const fs::path folder = files.at("folder").get<std::string>();
    for (const auto& [name, digest] : files.at("digests").items()) {
      const fs::path path = name;
      if (path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end())
        throw InputError("/files", fmt::format("the study reads {}, which is outside of its folder; expected files in "
                                               "it: copy it there, change its name in the study, and run again",
                                               name));
      if (file_hash(folder / path) != digest.get<std::string>())
        throw InputError("/files", fmt::format("{} has changed since the study ran", (folder / path).string()));
      parts.push_back(part_of((packed::study / path).generic_string(), folder / path));
    }
  }
  parts.push_back(part_of(study_name, dumped(study_part(results))));
}

const char* format_of(const std::string& name) {
  static const std::map<std::string, const char*> known = {
      {".csv", "text/csv"},     {".json", "application/json"},          {".html", "text/html"},
      {".md", "text/markdown"}, {".sqlite", "application/vnd.sqlite3"}, {".txt", "text/plain"},
      {".mtx", "text/plain"}};
  const auto found = known.find(fs::path(name).extension().string());
  return found == known.end() ? "application/octet-stream" : found->second;
}

constexpr const char* packer_id = "#packer";

Json properties(const Environment& environment) {
  Json facts = Json::array();
  for (const auto& [name, value] : environment.entries)
    facts.push_back({{"@type", "PropertyValue"}, {"name", name}, {"value", without_place(name, value)}});
  return facts;
}

/// What the parts are and what made them, as research objects are described. Source: RO-Crate 1.1.
std::string crate(const StudyResults& results, const std::vector<Part>& parts, const Environment& packer) {
  const auto refers = [](const std::string& id) { return Json{{"@id", id}}; };
  const std::string started = environment_entry(results.environment, kStarted);
  Json all = Json::array(), given = Json::array(), made = Json::array(), files = Json::array();
  for (const Part& part : parts) {
    all.push_back(refers(part.name));
    (part.name.starts_with(packed::study) ? given : made).push_back(refers(part.name));
    files.push_back({{"@id", part.name},
                     {"@type", "File"},
                     {"name", fs::path(part.name).filename().string()},
                     {"contentSize", fmt::format("{}", part.size)},
                     {"encodingFormat", format_of(part.name)},
                     {"sha256", part.sum}});
  }
  Json graph = {
      {{"@id", packed::crate},
       {"@type", "CreativeWork"},
       {"conformsTo", refers("https://w3id.org/ro/crate/1.1")},
       {"about", refers("./")}},
      {{"@id", "./"},
       {"@type", "Dataset"},
       {"name", results.name},
       {"description", results.question},
       {"datePublished", started},
       {"license", "none chosen; ask whoever packed it"},
       {"hasPart", all},
       {"mentions", refers("#run")}},
      {{"@id", "#run"},
       {"@type", "CreateAction"},
       {"name", fmt::format("{} of {} cases of kind {}", results.cases.size(), results.expected_cases, results.kind)},
       {"startTime", started},
       {"instrument", refers("#ricochet")},
       {"object", given},
       {"result", made}},
      {{"@id", "#ricochet"},
       {"@type", "SoftwareApplication"},
       {"name", "Ricochet"},
       {"version", environment_entry(results.environment, "program")},
       {"additionalProperty", properties(results.environment)}}};
  if (!packer.entries.empty())
    graph.push_back({{"@id", packer_id},
                     {"@type", "SoftwareApplication"},
                     {"name", "Ricochet"},
                     {"version", environment_entry(packer, "program")},
                     {"additionalProperty", properties(packer)}});
  for (Json& file : files) graph.push_back(std::move(file));
  return dumped({{"@context", "https://w3id.org/ro/crate/1.1/context"}, {"@graph", graph}});
}

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// The one graph of a description; none where it is no such thing.
Json graph_of(const fs::path& place) {
  Json described = Json::parse(text_of(place / packed::crate), nullptr, false);
  if (!described.is_object() || !described.contains("@graph") || !described["@graph"].is_array()) return {};
  return std::move(described["@graph"]);
}

/// What any version says of its parts: each but itself and the manifest, with its sum. "": nothing is wrong.
std::string fault_of_description(const fs::path& place, std::map<std::string, std::string> sums) {
  sums.erase(packed::crate);
  const Json graph = graph_of(place);
  if (!graph.is_array()) return fmt::format("its part {} describes nothing", packed::crate);
  const auto word = [](const Json& item, const char* key) {
    return item.is_object() && item.contains(key) && item[key].is_string() ? item[key].get<std::string>() : "";
  };
  for (const Json& item : graph) {
    if (word(item, "@type") != "File") continue;
    const std::string name = word(item, "@id");
    const auto part = sums.find(name);
    if (part == sums.end() || part->second != word(item, "sha256"))
      return fmt::format("{} says of \"{}\" what {} does not", packed::crate, plain_text(name), packed::sums);
    sums.erase(part);
  }
  return sums.empty() ? "" : fmt::format("{} does not describe \"{}\"", packed::crate, sums.begin()->first);
}

/// Whether any packed result may have such a part.
bool has_place(const std::string& name) {
  return name == packed::crate || name == packed::answer || name == packed::sums ||
         name.starts_with(std::string(packed::results) + "/") || name.starts_with(std::string(packed::study) + "/");
}

/// name → sum of the lines "SUM  NAME".
std::map<std::string, std::string> read_sums(const fs::path& file, const std::string& text) {
  std::map<std::string, std::string> sums;
  std::istringstream lines(text);
  constexpr std::size_t digits = 64;
  for (std::string line; std::getline(lines, line);) {
    if (line.size() <= digits + 2 || line.substr(digits, 2) != "  " ||
        line.find_first_not_of("0123456789abcdef") != digits)
      throw InputError("", fmt::format("{}: {} has a line that is none: \"{}\"", file.string(), packed::sums,
                                       plain_text(line.substr(0, digits))));
    if (const std::string name = line.substr(digits + 2); !sums.emplace(name, line.substr(0, digits)).second)
      throw InputError(
          "", fmt::format("{}: {} names the part \"{}\" twice", file.string(), packed::sums, plain_text(name)));
  }
  return sums;
}

}  // namespace

std::size_t pack_results(const fs::path& folder, const StudyResults& results, const std::string& answer,
                         const fs::path& file, const Environment& packer) {
  std::vector<Part> parts;
  add_results(folder, parts);
  add_study(results, parts);
  parts.push_back(part_of(packed::answer, answer));
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.name < b.name; });
  parts.insert(parts.begin(), part_of(packed::crate, crate(results, parts, packer)));
  std::string sums;
  for (const Part& part : parts) sums += part.sum + "  " + part.name + "\n";
  ZipWriter zip(file);
  zip.add(packed::sums, sums);
  for (const Part& part : parts) part.file.empty() ? zip.add(part.name, part.text) : zip.add_file(part.name, part.file);
  zip.commit();
  return parts.size() + 1;
}

std::vector<std::string> unpack_results(const fs::path& file, const fs::path& place) {
  const auto refuse = [&](const std::string& cause) {
    throw InputError("", fmt::format("{}: {}", file.string(), cause));
  };
  std::map<std::string, std::string> found;
  std::string current;
  Sha256 sum;
  std::optional<FileWriter> out;
  read_zip(file, {.begin =
                      [&](const std::string& name) {
                        current = name;
                        sum = Sha256();
                        make_folder((place / name).parent_path());
                        out.emplace(place / name);
                      },
                  .data =
                      [&](std::string_view bytes) {
                        sum.add(bytes);
                        out->write(bytes);
                      },
                  .end =
                      [&] {
                        out->commit();
                        out.reset();
                        found[current] = sum.digits();
                      }});
  if (found.erase(packed::sums) == 0)
    refuse(fmt::format("has no part {}: a packed result of `ricochet pack` has one", packed::sums));
  std::vector<std::string> names = {packed::sums};
  const std::map<std::string, std::string> sums = read_sums(file, text_of(place / packed::sums));
  for (const auto& [name, expected] : sums) {
    const auto part = found.find(name);
    if (part == found.end()) refuse(fmt::format("its part \"{}\" is missing", plain_text(name)));
    if (part->second != expected) refuse(fmt::format("its part \"{}\" is not as it was packed: another SHA-256", name));
    found.erase(part);
    names.push_back(name);
  }
  if (!found.empty())
    refuse(fmt::format("its part \"{}\" was not packed: {} does not name it", found.begin()->first, packed::sums));
  const std::string results = std::string(packed::results) + "/";
  for (const std::string& name :
       {std::string(packed::crate), std::string(packed::answer), study_name, results + "results.sqlite",
        results + "report.html", results + "cases.csv", results + "dictionary.csv"})
    if (!fs::exists(place / name)) refuse(fmt::format("has no part {}", name));
  for (const std::string& name : names)
    if (!has_place(name)) refuse(fmt::format("its part \"{}\" is none that a packed result has", plain_text(name)));
  if (const std::string fault = fault_of_description(place, sums); !fault.empty()) refuse(fault);
  return names;
}

std::string other_than_described(const fs::path& place, const std::vector<std::string>& names,
                                 const StudyResults& results, const Environment& packer) {
  std::vector<Part> parts;
  std::set<std::string> known = {study_name};
  if (names_files(results))
    for (const auto& [name, digest] : results.study["files"].at("digests").items()) {
      const std::string part = (packed::study / fs::path(name)).generic_string();
      if (!fs::is_regular_file(place / part) || file_hash(place / part) != digest.get<std::string>()) return part;
      known.insert(part);
    }
  for (const std::string& name : names) {
    if (name.starts_with(std::string(packed::study) + "/") && !known.contains(name)) return name;
    if (name != packed::sums && name != packed::crate) parts.push_back(part_of(name, place / name));
  }
  if (text_of(place / study_name) != dumped(study_part(results))) return study_name;
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.name < b.name; });
  return text_of(place / packed::crate) == crate(results, parts, packer) ? "" : packed::crate;
}

bool same_study(const fs::path& place, const StudyResults& results) {
  return Json::parse(text_of(place / study_name), nullptr, false) == study_part(results);
}

Environment packer_of(const fs::path& place) {
  Environment packer;
  try {
    for (const Json& one : graph_of(place))
      if (one.at("@id") == packer_id)
        for (const Json& fact : one.at("additionalProperty"))
          packer.entries.emplace_back(fact.at("name").get<std::string>(), fact.at("value").get<std::string>());
  } catch (const Json::exception&) {
    return {};
  }
  return packer;
}

}  // namespace ricochet
