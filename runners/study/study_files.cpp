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

/// The name of a file of the structure, its folder before it.
std::string file_of(const Json& structure, const std::string& key) {
  const Json& name = structure.at(Json::json_pointer("/" + key));
  return (std::filesystem::path(structure.value("folder", "")) / name.get<std::string>()).string();
}

/// Calls `visit(object, key, name)` for each file that a scene names: of a structure by its key, else with "".
template <class Visit>
void for_each_file(Json& scene, Visit visit) {
  for (Json* history : histories_with_files(scene))
    visit(*history, std::string(), history->at("file").get<std::string>());
  const auto of_structure = [&](Json& structure) {
    for (const std::string& key : file_keys(structure)) visit(structure, key, file_of(structure, key));
  };
  if (scene.contains("bodies"))
    for (Json& structure : scene["bodies"]) of_structure(structure);
  if (scene.contains("structure")) of_structure(scene["structure"]);
  for (Json* initial : initial_objects(scene))
    if (initial->contains("file")) visit(*initial, std::string(), initial->at("file").get<std::string>());
}

std::string structure_pointer(const std::string& key) {
  return "/scene/structure/" + key;
}

/// How the dofs of a table follow a support: columns dof and value, those left out 0.
AssembledFiles::Influence read_influence(const CsvFile& table, const std::string& support, std::size_t dofs) {
  const std::size_t dof = table.column("dof"), value = table.column("value");
  AssembledFiles::Influence out{support, table.name, {}};
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

/// Refuses a value in a unit of its own, unless a factor stands beside it.
void expect_unit(const std::string& unit, bool scaled, const std::string& what) {
  static const std::set<std::string> known = {"",    "1",    "-",     "m",    "rad",    "N",     "Nm",  "N.m",  "N m",
                                              "m/s", "m/s2", "m/s^2", "m/s²", "m/s**2", "m s-2", "N/m", "rad/s"};
  if (scaled || known.contains(unit)) return;
  throw FileError(fmt::format("{} is in {}; expected \"factor\", which makes SI units of it", what, shortened(unit)));
}

/// What the values of a table are of.
struct Abscissa {
  const char *key, *symbol, *plural;
  std::vector<std::string> units;  ///< that a header may say, SI first
};

const Abscissa instants = {"time", "t", "times", {"s", "sec", "seconds"}},
               frequencies = {"frequency", "f", "frequencies", {"Hz", "hz", "1/s"}};

/// The unit of what a spectrum is of: "N^2/Hz" → "N".
std::string unit_in_spectrum(const std::string& unit, const std::string& what) {
  if (unit.empty() || unit == "1/Hz") return "";
  for (const std::string_view end : {"**2/Hz", "^2/Hz", "²/Hz", "2/Hz"})
    if (unit.ends_with(end)) return unit.substr(0, unit.size() - end.size());
  throw FileError(
      fmt::format("{} is in {}; expected N²/Hz, or \"factor\", which makes that of it", what, shortened(unit)));
}

/// The columns of a table: instants, or frequencies, and values.
void read_columns(const CsvFile& csv, const Abscissa& along, const std::string& first, const std::string& value,
                  bool scaled, TimeTable& table) {
  const std::size_t t = csv.column(first), v = csv.column(value);
  if (const std::string unit = csv.unit(t);
      !unit.empty() && std::find(along.units.begin(), along.units.end(), unit) == along.units.end())
    throw FileError(fmt::format("{}: the column {} is in {}; expected {}", csv.name, csv.columns[t], shortened(unit),
                                along.units.front()));
  const bool spectrum = &along == &frequencies;
  const std::string unit = csv.unit(v), what = fmt::format("{}: the column {}", csv.name, csv.columns[v]);
  expect_unit(spectrum && !scaled ? unit_in_spectrum(unit, what) : unit, scaled, what);
  for (const CsvFile::Row& row : csv.rows) {
    table.times.push_back(csv.number(row, t));
    table.values.push_back(csv.number(row, v));
    const std::size_t n = table.times.size();
    if (n > 1 && !(table.times[n - 1] > table.times[n - 2]))
      csv.fail(row, fmt::format("{} = {:.9g} after {:.9g}; {} must increase", along.symbol, table.times[n - 1],
                                table.times[n - 2], along.plural));
  }
}

}  // namespace

StudyFiles::StudyFiles(std::filesystem::path folder, const Json& known, bool outside)
    : folder_(std::filesystem::absolute(folder.empty() ? "." : folder).lexically_normal()),
      known_(known),
      outside_(outside) {
  if (known_.is_object()) folder_ = known_.at("folder").get<std::string>();
}

const StudyFiles::File& StudyFiles::file(const std::string& name, const std::string& pointer) {
  if (!is_plain(name))
    throw InputError(pointer, fmt::format("\"{}\" has control characters or bytes that are no UTF-8; expected the name "
                                          "of a file without them",
                                          plain_text(shortened(name))));
  const std::filesystem::path path = name;
  bool leaves = path.is_absolute();
  for (const auto& part : path) leaves = leaves || part == "..";
  // A link may lead out of the folder.
  if ((leaves || !lies_within(folder_, folder_ / path)) && !outside_)
    throw InputError(pointer,
                     fmt::format("\"{}\" is outside the folder of the study; expected a file in it, or a study "
                                 "that says \"outside\": true",
                                 shortened(name)));
  File& one = files_[name];
  if (!one.content.empty()) return one;
  const Json digests = known_.is_object() ? known_.at("digests") : Json::object();
  try {
    one.content = read_file(folder_, name);
  } catch (const FileError& error) {
    const bool known = !one.digest.empty() || digests.contains(name);
    throw InputError(pointer, known ? fmt::format("{} {}: {}", name, changed_since, error.what()) : error.what());
  }
  const std::string digest = content_hash(one.content);
  const std::string before = one.digest.empty() ? digests.value(name, digest) : one.digest;
  if (before != digest) throw InputError(pointer, name + " " + changed_since);
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
  const auto matrix = [&](const std::string& key, const std::string& name, const DofTable& table) {
    FileMatrix read = read_matrix_market(content(key), name, static_cast<int>(table.dofs.size()), table.name);
    note(file_of(structure, key), read.notes);
    return read;
  };
  try {
    AssembledFiles files;
    files.stiffness_name = structure.at("stiffness").get<std::string>();
    files.mass_name = structure.at("mass").get<std::string>();
    files.length_unit = unit;
    const std::string table = structure.at("dofs").get<std::string>();
    files.table = read_dof_table(content("dofs"), table);
    note(file_of(structure, "dofs"), files.table.notes);
    files.stiffness = matrix("stiffness", files.stiffness_name, files.table);
    files.mass = matrix("mass", files.mass_name, files.table);
    const Json influence = structure.value("influence", Json::object());
    for (const auto& [support, name] : influence.items()) {
      const CsvFile csv = read_csv(content(pointer_to("influence", support)), name.get<std::string>());
      note(file_of(structure, reading), csv.notes);
      files.influences.push_back(read_influence(csv, support, files.table.dofs.size()));
    }
    if (keys.back() == damping_key) {
      files.damping_name = structure.at("damping").at("file").get<std::string>();
      files.damping = matrix(damping_key, files.damping_name, files.table);
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
      const std::string name = file_of(structure, key);
      tables[key] = read_csv(file(name, structure_pointer(key)).content, structure.at(key).get<std::string>());
      note(name, tables[key].notes);
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
  return columns(history, false, pointer);
}

TimeTable StudyFiles::spectrum(const Json& given, const std::string& pointer) {
  return columns(given, true, pointer);
}

TimeTable StudyFiles::columns(const Json& history, bool spectrum, const std::string& pointer) {
  const std::lock_guard lock(mutex_);
  const Abscissa& along = spectrum ? frequencies : instants;
  const auto name = history.at("file").get<std::string>(), first = history.at(along.key).get<std::string>(),
             value = history.at("value").get<std::string>();
  const std::string id = name + "\n" + along.key + "\n" + first + "\n" + value;
  if (const auto known = tables_.find(id); known != tables_.end()) return known->second;
  try {
    const std::string& content = file(name, pointer + "/file").content;
    const bool scaled = history.value("factor", 1.0) != 1.0;
    TimeTable table;
    table.name = name;
    if (auto at2 = read_at2(content, name)) {
      if (spectrum) throw FileError(name + " is a record over time; expected a table of frequencies and S(f)");
      expect_unit(at2->unit, scaled, name);
      note(name, at2->notes);
      for (std::size_t k = 0; k < at2->values.size(); ++k) table.times.push_back(static_cast<double>(k) * at2->step);
      table.values = std::move(at2->values);
    } else {
      const CsvFile csv = read_csv(content, name);
      note(name, csv.notes);
      read_columns(csv, along, first, value, scaled, table);
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
    note(name, table.notes);
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
  for_each_file(scene, [&](Json& object, const std::string& key, const std::string& name) {
    (key.empty() ? object["digest"] : object["digests"][key]) = files_.at(name).digest;
  });
}

std::vector<std::string> StudyFiles::notes(const Json& scene) const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> out;
  Json searched = scene;
  for_each_file(searched, [&](const Json&, const std::string&, const std::string& name) {
    const auto found = files_.find(name);
    if (found == files_.end()) return;
    for (const std::string& note : found->second.notes)
      if (std::find(out.begin(), out.end(), note) == out.end()) out.push_back(note);
  });
  return out;
}

void StudyFiles::note(const std::string& name, const std::vector<std::string>& notes) {
  std::vector<std::string>& known = files_[name].notes;
  for (const std::string& one : notes)
    if (std::find(known.begin(), known.end(), one) == known.end()) known.push_back(one);
}

Json StudyFiles::said() const {
  const std::lock_guard lock(mutex_);
  if (files_.empty()) return nullptr;
  Json digests = Json::object();
  for (const auto& [name, one] : files_) digests[name] = one.digest;
  return {{"folder", folder_.string()}, {"digests", std::move(digests)}};
}

}  // namespace ricochet
