#include "runners/run/merge_folders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <map>
#include <ricochet/contract/errors.hpp>
#include <set>
#include <sstream>

#include "runners/kinds/stored_study.hpp"
#include "runners/march/study_identity.hpp"
#include "runners/run/environment.hpp"
#include "runners/run/finish_run.hpp"
#include "runners/run/say.hpp"
#include "runners/run/study_cases.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/checksums.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/folder_lock.hpp"
#include "runners/store/read_store.hpp"
#include "runners/store/record_values.hpp"
#include "runners/store/store.hpp"
#include "runners/table/table_reader.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& folder, const std::string& why) {
  throw InputError("", folder.string() + ": " + why);
}

/// The same path, where a store is that can be read.
const fs::path& readable(const fs::path& folder) {
  const StoreReader reader(folder);
  return folder;
}

/// A folder that is merged, locked as long as this lives.
struct MergedFolder {
  explicit MergedFolder(const fs::path& path) : folder(readable(path)), lock(path), head(StoreReader(path).head()) {}
  fs::path folder;
  FolderLock lock;
  StudyResults head;
  std::vector<StoreReader::Finished> finished = {};
  Damage damage = {};
};

/// The entries that say what computes: program and plugins, those of the machine left out.
std::vector<std::string> entries_that_differ(const Environment& there, const Environment& here) {
  std::vector<std::string> found;
  for (const auto& [name, value] : there.entries) {
    const bool computes = name == "program" || name == "commit" || name == "compiler" || name == "build type" ||
                          name == "flags" || name.starts_with("plugin ");
    const std::string other = environment_entry(here, name);
    if (computes && !other.empty() && without_place(name, value) != without_place(name, other))
      found.push_back(
          fmt::format("{} is {} there and {} here", name, without_place(name, value), without_place(name, other)));
  }
  return found;
}

class FolderMerge {
 public:
  FolderMerge(const std::vector<fs::path>& folders, const fs::path& out, const std::vector<fs::path>& plugins)
      : out_(out) {
    std::error_code error;
    if (fs::exists(out_, error) && (!fs::is_directory(out_, error) || !fs::is_empty(out_, error)))
      refuse(out, "it is there, and not an empty folder; merged results want a new one");
    open(folders);
    stored_.emplace(sources_.front().head, plugins);
    const auto libraries = [this](const StudyCase& one) { return libraries_of(one, stored_->registry); };
    expected_ = expected_cases(libraries, stored_->study);
    for (const ExpectedCase& one : expected_) fingerprints_[one.id] = one.fingerprint;
    for (MergedFolder& source : sources_) find_cases(source);
  }

  int run(const RenderReport& render, std::FILE* said) {
    std::unique_ptr<const AnalysedResults> results;
    {
      FolderWriter writer(out_);
      {
        Store store(writer.place(), false);
        write(store);
        results = write_folder(store, writer.place(), render);
      }
      writer.commit();
    }
    const int code = tell_results(
        said, *results, out_, fmt::format("merged from {} folder{}", sources_.size(), sources_.size() == 1 ? "" : "s"));
    for (const MergedFolder& source : sources_)
      if (source.damage.any()) say(said, damage_text(source.folder / "results.sqlite", source.damage) + "\n");
    if (const std::size_t missing = expected_.size() - results->cases.size(); missing > 0)
      say(said,
          fmt::format("{} of {} cases {} in none of these folders: `ricochet run {} --out {}` goes on\n", missing,
                      expected_.size(), missing == 1 ? "is" : "are", (out_ / "study.json").string(), out_.string()));
    return code;
  }

 private:
  void open(const std::vector<fs::path>& folders) {
    std::set<fs::path> met;
    for (const fs::path& folder : folders) {
      std::error_code error;
      if (const fs::path place = fs::canonical(folder, error); !error && !met.insert(place).second)
        refuse(folder, "this folder is named twice");
      const MergedFolder& source = sources_.emplace_back(folder);
      const MergedFolder& first = sources_.front();
      if (source.head.study == first.head.study && source.head.name == first.head.name) continue;
      if (source.head.name != first.head.name)
        refuse(folder, fmt::format("it holds the study \"{}\", and {} holds \"{}\"", source.head.name,
                                   first.folder.string(), first.head.name));
      const Json changes = Json::diff(first.head.study, source.head.study);
      refuse(folder, fmt::format("it holds another version of the study \"{}\" than {}: they differ at {}{}",
                                 source.head.name, first.folder.string(), changes.at(0).at("path").get<std::string>(),
                                 changes.size() > 1 ? fmt::format(" and {} more places", changes.size() - 1) : ""));
    }
  }

  /// What a folder has, and whether it can stand beside that of the folders before.
  void find_cases(MergedFolder& source) {
    const StoreReader reader(source.folder);
    source.finished = reader.finished();
    source.damage = reader.damage();
    std::map<const MergedFolder*, StoreReader> others;
    for (const StoreReader::Finished& one : source.finished) {
      const auto expected = fingerprints_.find(one.id);
      if (expected == fingerprints_.end() || expected->second != one.fingerprint) refuse_program(source, one.id);
      if (!one.refused && !one.arithmetic.empty()) check_arithmetic(source, one);
      const auto [holder, first] = holders_.emplace(one.id, &source);
      if (first) continue;
      StoreReader& other = others.try_emplace(holder->second, holder->second->folder).first->second;
      const Comparison found = compare(other.read(one.id), reader.read(one.id));
      if (!found.differences.empty())
        refuse(source.folder, fmt::format("its case {} is not that of {}: {}{}", one.id,
                                          holder->second->folder.string(), found.differences.front(),
                                          found.differences.size() > 1
                                              ? fmt::format(" (and {} more differences)", found.differences.size() - 1)
                                              : ""));
    }
  }

  [[noreturn]] void refuse_program(const MergedFolder& source, const std::string& id) const {
    const auto differ = entries_that_differ(source.head.environment, describe_environment(stored_->catalogue.opened()));
    refuse(
        source.folder,
        fmt::format("its case {} was computed by another program or with another plugin than these{}: merge with the "
                    "program that ran it",
                    id, differ.empty() ? "" : fmt::format(" ({})", fmt::join(differ, "; "))));
  }

  void check_arithmetic(const MergedFolder& source, const StoreReader::Finished& one) {
    if (arithmetic_.empty()) {
      arithmetic_ = one.arithmetic;
      arithmetic_of_ = source.folder;
    }
    if (one.arithmetic == arithmetic_) return;
    refuse(source.folder,
           fmt::format("its case {} was computed with other last digits (arithmetic {}) than those of {} (arithmetic "
                       "{}). Processors or C libraries differ, and one run would not have left both",
                       one.id, one.arithmetic, arithmetic_of_.string(), arithmetic_));
  }

  void write(Store& store) {
    StudyResults header = results_header(stored_->study);
    header.study = sources_.front().head.study;
    if (arithmetic_.empty()) arithmetic_ = arithmetic_digest();
    store.begin(header, expected_, arithmetic_);
    store.save_environment(environment());
    for (const MergedFolder& source : sources_) {
      const StoreReader reader(source.folder);
      for (const StoreReader::Finished& one : source.finished) {
        if (holders_.at(one.id) != &source) continue;
        const CaseRecord record = reader.read(one.id);
        store.save({&record, 1});
      }
    }
    copy_motions(store);
    store.nothing_under_way();
  }

  /// That of the run which began last, as if it had gone on with the cases of the others.
  Environment environment() const {
    std::vector<const MergedFolder*> order;
    for (const MergedFolder& source : sources_) order.push_back(&source);
    std::stable_sort(order.begin(), order.end(), [](const MergedFolder* a, const MergedFolder* b) {
      return environment_entry(a->head.environment, kStarted) > environment_entry(b->head.environment, kStarted);
    });
    Environment merged = order.front()->head.environment;
    for (const MergedFolder* one : order) merged = merge_environments(merged, one->head.environment);
    return merged;
  }

  /// Of what several cases share all; of what a case has so far, where none has finished it, what one folder has.
  void copy_motions(Store& store) const {
    std::map<std::string, std::string> ids;
    for (const auto& [id, fingerprint] : fingerprints_) ids[fingerprint] = id;
    std::map<std::string, const MergedFolder*> of_case;
    for (const MergedFolder& source : sources_) {
      const StoreReader reader(source.folder);
      for (const std::string& key : reader.motion_keys(arithmetic_)) {
        const std::string id = case_of_key(key, ids);
        if (holders_.count(id) != 0) continue;
        if (!id.empty() && of_case.emplace(id, &source).first->second != &source) continue;
        if (store.motion(key).empty()) store.save_motion(key, reader.motion(key, arithmetic_));
      }
    }
  }

  /// The case whose fingerprint is a word of the key (WORD/FINGERPRINT/…); "" where none is.
  static std::string case_of_key(const std::string& key, const std::map<std::string, std::string>& ids) {
    std::istringstream words(key);
    for (std::string word; std::getline(words, word, '/');)
      if (const auto found = ids.find(word); found != ids.end()) return found->second;
    return "";
  }

  const fs::path out_;  // as it was told
  std::list<MergedFolder> sources_;
  std::optional<StoredStudy> stored_;
  std::vector<ExpectedCase> expected_;
  std::map<std::string, std::string> fingerprints_;     // by id
  std::map<std::string, const MergedFolder*> holders_;  // of each finished case the first folder that has it
  std::string arithmetic_;
  fs::path arithmetic_of_;
};

}  // namespace

int merge_folders_with(const RenderReport& render, const std::vector<fs::path>& folders, const fs::path& out,
                       const std::vector<fs::path>& plugins, std::FILE* said) {
  return FolderMerge(folders, out, plugins).run(render, said);
}

namespace {

void compare_series(const std::string& what, const std::vector<double>& stored, const std::vector<double>& again,
                    Comparison& out) {
  ++out.series;
  if (stored.size() != again.size()) {
    out.differences.push_back(fmt::format("{} has {} numbers, stored are {}", what, again.size(), stored.size()));
    return;
  }
  for (std::size_t i = 0; i < stored.size(); ++i)
    if (!same_bits(stored[i], again[i])) {
      out.differences.push_back(fmt::format("{} differs from number {} on: {}, stored is {}", what, i,
                                            csv_number(again[i]), csv_number(stored[i])));
      return;
    }
}

void compare_measures(const CaseRecord& stored, const CaseRecord& again, Comparison& out) {
  const auto of_motion = [](const std::string& name) {
    const MeasureInfo* info = measure_info(name);
    return !info || info->of == MeasureInfo::Of::motion;
  };
  for (const auto& [name, value] : again.measures) {
    if (!of_motion(name)) continue;
    ++out.measures;
    const auto kept = measure(stored, name);
    if (!kept)
      out.differences.push_back(fmt::format("{} is {}, and is not stored", name, csv_number(value)));
    else if (*kept != value)  // the store keeps no sign of a zero
      out.differences.push_back(fmt::format("{} is {}, stored is {}", name, csv_number(value), csv_number(*kept)));
  }
  for (const auto& [name, value] : stored.measures)
    if (of_motion(name) && !measure(again, name))
      out.differences.push_back(fmt::format("{} is stored as {}, and is not measured", name, csv_number(value)));
}

}  // namespace

Comparison compare(const CaseRecord& stored, const CaseRecord& again) {
  Comparison out;
  if (stored.status != again.status)
    out.differences.push_back(fmt::format("it is {}, stored as {}", word(again.status), word(stored.status)));
  if (stored.steps != again.steps)
    out.differences.push_back(fmt::format("it takes {} steps, stored are {}", again.steps, stored.steps));
  compare_measures(stored, again, out);
  for (std::size_t c = 0; c < again.curve.names.size(); ++c)
    for (std::size_t k = 0; k < stored.curve.names.size(); ++k)
      if (stored.curve.names[k] == again.curve.names[c])
        compare_series("the curve's " + again.curve.names[c], stored.curve.columns[k], again.curve.columns[c], out);
  for (const NumberTable& numbers : again.numbers)
    if (const NumberTable* kept = find_table(stored.numbers, numbers.name))
      for (std::size_t c = 0; c < numbers.columns.size(); ++c)
        if (const auto* series = kept->numbers(numbers.columns[c].name))
          compare_series(numbers.name + "." + numbers.columns[c].name, *series, numbers.values[c], out);
  for (const Table& table : again.tables) {
    const Table* kept = find_table(stored.tables, table.name);
    if (!kept) continue;
    ++out.tables;
    if (kept->rows != table.rows)
      out.differences.push_back(fmt::format("rows of {} differ from those stored", table.name));
  }
  return out;
}

std::string text(const Comparison& comparison) {
  if (comparison.differences.empty())
    return fmt::format("as stored to the last bit: {} measures, {} series of numbers, {} tables\n", comparison.measures,
                       comparison.series, comparison.tables);
  constexpr std::size_t told = 20;
  std::string out = "not as stored, the results are of another build of the program or of its plugins:\n";
  for (std::size_t k = 0; k < comparison.differences.size() && k < told; ++k)
    out += "  " + comparison.differences[k] + "\n";
  if (comparison.differences.size() > told) out += fmt::format("  and {} more\n", comparison.differences.size() - told);
  return out;
}

}  // namespace ricochet
