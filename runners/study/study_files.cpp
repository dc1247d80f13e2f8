#include "runners/study/study_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ricochet/scene/files/text_file.hpp>
#include <ricochet/scene/structure/assembled_structure.hpp>
#include <set>

#include "runners/study/histories.hpp"
#include "runners/study/scene_keys.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

constexpr const char* damping_key = "damping/file";
constexpr const char* modal_keys[] = {"modes", "shapes", "residual", "residual_mass", "static_modes"};

/// Keys of a structure that name its files: "influence/ground" for a key of an object of names.
std::vector<std::string> file_keys(const Json& structure) {
  std::vector<std::string> keys;
  if (structure.at("type") == "modal")
    for (const char* key : modal_keys)
      if (!structure.value(key, "").empty()) keys.emplace_back(key);
  if (structure.at("type") != "assembled") return keys;
  keys = {"dofs", "stiffness", "mass"};
  const Json influence = structure.value("influence", Json::object());
  for (const auto& [support, ignored] : influence.items()) keys.push_back(pointer_to("influence", support));
  if (!structure.at("damping").value("file", "").empty()) keys.emplace_back(damping_key);
  return keys;
}

std::string structure_pointer(const std::string& key) {
  return "/scene/structure/" + key;
}

/// The name of a file of the structure, its folder before it.
std::string file_of(const Json& structure, const std::string& key) {
  const Json& name = structure.at(Json::json_pointer("/" + key));
  return (std::filesystem::path(structure.value("folder", "")) / name.get<std::string>()).string();
}

/// How the dofs of a table follow a support: columns dof and value, those left out 0.
AssembledFiles::Influence read_influence(const std::string& content, const std::string& support,
                                         const std::string& name, std::size_t dofs) {
  const CsvFile table = read_csv(content, name);
  const std::size_t dof = table.column("dof"), value = table.column("value");
  AssembledFiles::Influence out{support, name, {}};
  std::set<long long> met;
  for (const CsvFile::Row& row : table.rows) {
    const long long number = whole_number(row.cells[dof]).value_or(0);
    if (number < 1 || number > static_cast<long long>(dofs))
      table.fail(row, fmt::format("\"{}\" for dof; expected 1 to {}", shortened(row.cells[dof]), dofs));
    if (!met.insert(number).second) table.fail(row, fmt::format("dof {} stands a second time", number));
    out.values.emplace_back(static_cast<int>(number), table.number(row, value));
  }
  return out;
}

}  // namespace

StudyFiles::StudyFiles(std::filesystem::path folder, const Json& known, bool outside)
    : folder_(std::filesystem::absolute(folder.empty() ? "." : folder).lexically_normal()),
      known_(known),
      outside_(outside) {
  if (known_.is_object()) folder_ = known_.at("folder").get<std::string>();
}

const StudyFiles::File& StudyFiles::file(const std::string& name, const std::string& pointer) {
  const std::filesystem::path path = name;
  bool leaves = path.is_absolute();
  for (const auto& part : path) leaves = leaves || part == "..";
  if (leaves && !outside_)
    throw InputError(pointer,
                     fmt::format("\"{}\" is outside the folder of the study; expected a file in it, or a study "
                                 "that says \"outside\": true",
                                 shortened(name)));
  File& one = files_[name];
  if (!one.content.empty()) return one;
  try {
    one.content = read_file(folder_, name);
  } catch (const FileError& error) {
    throw InputError(pointer, error.what());
  }
  const std::string digest = content_hash(one.content);
  const Json digests = known_.is_object() ? known_.at("digests") : Json::object();
  const std::string before = one.digest.empty() ? digests.value(name, digest) : one.digest;
  if (before != digest) throw InputError(pointer, name + " has changed since the run began");
  one.digest = digest;
  return one;
}

std::shared_ptr<const AssembledStructure> StudyFiles::assembled(const Json& structure) {
  const std::lock_guard lock(mutex_);
  const double unit = structure.at("length_unit").get<double>();
  std::string id = fmt::format("{}", unit);
  const std::vector<std::string> keys = file_keys(structure);
  for (const std::string& key : keys) id += "\n" + key + "\n" + file_of(structure, key);
  const auto known = structures_.find(id);
  if (known != structures_.end()) return known->second;
  std::string reading = "dofs";
  const auto content = [&](const std::string& key) -> const std::string& {
    return file(file_of(structure, reading = key), structure_pointer(key)).content;
  };
  try {
    AssembledFiles files;
    files.stiffness_name = structure.at("stiffness").get<std::string>();
    files.mass_name = structure.at("mass").get<std::string>();
    files.length_unit = unit;
    const std::string table = structure.at("dofs").get<std::string>();
    files.table = read_dof_table(content("dofs"), table);
    const auto dofs = static_cast<int>(files.table.dofs.size());
    files.stiffness = read_matrix_market(content("stiffness"), files.stiffness_name, dofs, table);
    files.mass = read_matrix_market(content("mass"), files.mass_name, dofs, table);
    const Json influence = structure.value("influence", Json::object());
    for (const auto& [support, name] : influence.items())
      files.influences.push_back(read_influence(content(pointer_to("influence", support)), support,
                                                name.get<std::string>(), files.table.dofs.size()));
    if (keys.back() == damping_key) {
      files.damping_name = structure.at("damping").at("file").get<std::string>();
      files.damping = read_matrix_market(content(damping_key), files.damping_name, dofs, table);
    }
    reading = "";
    const auto made = std::make_shared<const AssembledStructure>(assemble_structure(files));
    for (const std::string& key : keys) std::string().swap(files_[file_of(structure, key)].content);
    return structures_[id] = made;
  } catch (const FileError& error) {
    throw InputError(reading.empty() ? "/scene/structure" : structure_pointer(reading), error.what());
  }
}

std::shared_ptr<const AssembledStructure> StudyFiles::modal(const Json& structure, std::vector<double>& ratios) {
  const std::lock_guard lock(mutex_);
  std::string id = "modes";
  const std::vector<std::string> keys = file_keys(structure);
  for (const std::string& key : keys) id += "\n" + key + " " + file_of(structure, key);
  const auto known = structures_.find(id);
  if (known != structures_.end()) {
    ratios = ratios_.at(id);
    return known->second;
  }
  std::string reading;
  try {
    std::map<std::string, CsvFile> tables;
    for (const std::string& key : keys) {
      reading = key;
      tables[key] =
          read_csv(file(file_of(structure, key), structure_pointer(key)).content, structure.at(key).get<std::string>());
    }
    reading.clear();
    const auto optional = [&](const char* key) {
      return tables.contains(key) ? std::optional(tables.at(key)) : std::nullopt;
    };
    const ModalFiles files{tables.at("modes"), tables.at("shapes"), optional("residual"), optional("residual_mass"),
                           optional("static_modes")};
    const auto made = std::make_shared<const AssembledStructure>(modal_structure(files, ratios));
    for (const std::string& key : keys) std::string().swap(files_[file_of(structure, key)].content);
    ratios_[id] = ratios;
    return structures_[id] = made;
  } catch (const FileError& error) {
    throw InputError(reading.empty() ? "/scene/structure" : structure_pointer(reading), error.what());
  }
}

TimeTable StudyFiles::table(const Json& history, const std::string& pointer) {
  const std::lock_guard lock(mutex_);
  const auto name = history.at("file").get<std::string>(), time = history.at("time").get<std::string>(),
             value = history.at("value").get<std::string>();
  const std::string id = name + "\n" + time + "\n" + value;
  if (const auto known = tables_.find(id); known != tables_.end()) return known->second;
  try {
    const CsvFile csv = read_csv(file(name, pointer + "/file").content, name);
    const std::size_t t = csv.column(time), v = csv.column(value);
    TimeTable table;
    table.name = name;
    for (const CsvFile::Row& row : csv.rows) {
      table.times.push_back(csv.number(row, t));
      table.values.push_back(csv.number(row, v));
      const std::size_t n = table.times.size();
      if (n > 1 && !(table.times[n - 1] > table.times[n - 2]))
        csv.fail(row,
                 fmt::format("t = {:.9g} after {:.9g}; times must increase", table.times[n - 1], table.times[n - 2]));
    }
    std::string().swap(files_[name].content);
    return tables_[id] = std::move(table);
  } catch (const FileError& error) {
    throw InputError(pointer, error.what());
  }
}

std::vector<DofState> StudyFiles::initial(const Json& initial, const Json& structure, const std::string& pointer) {
  const auto name = initial.at("file").get<std::string>();
  if (file_keys(structure).empty())
    throw InputError(pointer, "the file of an initial state is one of matrices that are given; expected formulas in x");
  std::vector<double> ratios;
  const std::shared_ptr<const AssembledStructure> made =
      structure.at("type") == "modal" ? modal(structure, ratios) : assembled(structure);
  const std::lock_guard lock(mutex_);
  try {
    const CsvFile table = read_csv(file(name, pointer).content, name);
    const bool numbered = std::find(table.columns.begin(), table.columns.end(), "dof") != table.columns.end();
    const std::size_t displacement = table.column("displacement"), velocity = table.column("velocity"),
                      node = table.column(numbered ? "dof" : "node"),
                      component = numbered ? node : table.column("component");
    std::vector<DofState> out;
    std::set<int> met;
    for (const CsvFile::Row& row : table.rows) {
      const auto known = made->nodes.find(row.cells[node]);
      int dof = 0;
      if (numbered)
        dof = static_cast<int>(std::min<long long>(whole_number(row.cells[node]).value_or(0), 1LL << 30U));
      else if (known != made->nodes.end() && known->second.dofs.contains(row.cells[component]))
        dof = known->second.dofs.at(row.cells[component]);
      if (dof < 1 || dof > static_cast<int>(made->where.size()))
        table.fail(row, fmt::format("no dof {}{}{} in {}", row.cells[node], numbered ? "" : " ",
                                    numbered ? "" : row.cells[component], made->table_name));
      if (!met.insert(dof).second) table.fail(row, fmt::format("dof {} stands a second time", dof));
      out.push_back({dof, table.number(row, displacement), table.number(row, velocity)});
    }
    return out;
  } catch (const FileError& error) {
    throw InputError(pointer, error.what());
  }
}

void StudyFiles::add_digests(Json& scene) const {
  const std::lock_guard lock(mutex_);
  const auto digest = [&](const std::string& name) { return files_.at(name).digest; };
  for (Json* history : histories_with_files(scene))
    (*history)["digest"] = digest(history->at("file").get<std::string>());
  const auto add = [&](Json& structure) {
    const std::vector<std::string> keys = file_keys(structure);
    for (const std::string& key : keys) structure["digests"][key] = digest(file_of(structure, key));
    return !keys.empty();
  };
  if (scene.contains("bodies"))
    for (Json& structure : scene["bodies"]) add(structure);
  if (scene.contains("structure")) add(scene["structure"]);
  for (Json* initial : initial_objects(scene))
    if (initial->contains("file")) (*initial)["digest"] = digest(initial->at("file").get<std::string>());
}

Json StudyFiles::said() const {
  const std::lock_guard lock(mutex_);
  if (files_.empty()) return nullptr;
  Json digests = Json::object();
  for (const auto& [name, one] : files_) digests[name] = one.digest;
  return {{"folder", folder_.string()}, {"digests", std::move(digests)}};
}

}  // namespace ricochet
