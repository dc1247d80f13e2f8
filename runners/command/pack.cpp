#include "runners/pack/pack.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <ostream>
#include <random>
#include <set>
#include <system_error>

#include "runners/command/command.hpp"
#include "runners/command/subcommand.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/stored_study.hpp"
#include "runners/pack/sha256.hpp"
#include "runners/report/summary_page.hpp"
#include "runners/run/agreement.hpp"
#include "runners/run/analysed_results.hpp"
#include "runners/run/environment.hpp"
#include "runners/run/run_study.hpp"
#include "runners/run/study_runner.hpp"
#include "runners/store/atomic_file.hpp"
#include "runners/store/fingerprint.hpp"
#include "runners/store/folder_lock.hpp"
#include "runners/store/store.hpp"
#include "runners/store/temporary_folder.hpp"
#include "runners/table/text.hpp"

namespace ricochet {
namespace fs = std::filesystem;
namespace {

constexpr int drawn_by_default = 3;

std::string counted(std::size_t number, const char* what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

/// How many cases `--cases` asks for; at most `all`.
std::size_t cases_asked(const std::string& text, std::size_t all) {
  if (text == "all") return all;
  if (text.empty()) return std::min<std::size_t>(drawn_by_default, all);
  constexpr std::size_t most_digits = 9;
  if (text.size() > most_digits || text.find_first_not_of("0123456789") != std::string::npos)
    throw UsageError(fmt::format("--cases \"{}\": expected a number of cases, or all", text));
  return std::min<std::size_t>(std::stoul(text), all);
}

/// Cases that march: what is refused, unfinished or of a reference is not computed again.
std::vector<const CaseRecord*> cases_that_march(const StudyResults& results) {
  std::vector<const CaseRecord*> found;
  for (const CaseRecord& record : results.cases)
    if (record.status != Status::refused && !record.partial && !is_reference(record)) found.push_back(&record);
  return found;
}

/// So many of them, drawn, in their order.
std::vector<const CaseRecord*> drawn(const std::vector<const CaseRecord*>& all, std::size_t count) {
  std::vector<const CaseRecord*> found;
  std::mt19937_64 random{std::random_device{}()};
  std::sample(all.begin(), all.end(), std::back_inserter(found), count, random);
  return found;
}

/// What decides the last digits of a table.
Environment program_here() {
  const Environment here = describe_environment({});
  Environment program;
  for (const char* name : {"program", "commit", "compiler", "contract", kArithmetic})
    program.entries.emplace_back(name, environment_entry(here, name));
  return program;
}

/// What computes here and did not there, a line.
std::string other_program(const Environment& there) {
  const Environment here = program_here();
  std::string text;
  for (const auto& [name, ignored] : here.entries)
    if (const std::string a = environment_entry(there, name), b = environment_entry(here, name); a != b)
      text += fmt::format("{}{} {} there, {} here", text.empty() ? "computed with " : "; ", name, a, b);
  return text.empty() ? "" : text + "\n";
}

bool same_bytes(const fs::path& a, const fs::path& b) {
  return fs::is_regular_file(a) && fs::is_regular_file(b) && fs::file_size(a) == fs::file_size(b) &&
         file_sha256(a) == file_sha256(b);
}

/// Whether study, tables, answer, report and description are what this program makes of the store beside them. Throws
/// InputError for the first that is not. Another program may write all of these otherwise: of what it packed the study
/// alone is compared, by what it says, and a difference is told, not judged.
void compare_with_store(const fs::path& file, const std::vector<std::string>& parts, const AnalysedResults& results,
                        const fs::path& place, std::ostream& out) {
  const Environment here = program_here();
  if (packer_of(place).entries != here.entries) {
    out << "tables, answer and report are not compared with the store: another program packed them\n"
        << (same_study(place, results) ? "the study says what the store says\n"
                                       : "the study is not, as this program reads it, that of the store: another "
                                         "version may write it otherwise\n");
    return;
  }
  const TemporaryFolder made("tables");
  make_folder(made.path() / packed::results);
  write_results(results, made.path() / packed::results);
  write_file(made.path() / packed::answer, report::index_markdown({{results, ""}}));
  std::set<std::string> names;
  for (const auto& item : fs::recursive_directory_iterator(made.path()))
    if (item.is_regular_file()) names.insert(item.path().lexically_relative(made.path()).generic_string());
  const std::string folder = std::string(packed::results) + "/";
  for (const std::string& part : parts)
    if (part.starts_with(folder) && !part.starts_with(folder + "results.sqlite")) names.insert(part);
  if (results.study.contains("beneath")) names.erase(folder + "report.html");  // it shows another folder's points
  for (const std::string& name : names)
    if (!same_bytes(made.path() / name, place / name))
      throw InputError("", fmt::format("{}: {} is not what its store says", file.string(), name));
  if (const std::string name = other_than_described(place, parts, results, here); !name.empty())
    throw InputError("", fmt::format("{}: {} is not what its store says", file.string(), name));
  out << "study, tables, answer, report and description are what the store says\n";
}

int compute_again(const Arguments& arguments, const std::vector<std::string>& parts, const fs::path& place,
                  std::ostream& out) {
  AnalysedResults results(read_store(place / packed::results));
  compare_with_store(arguments.operands.front(), parts, results, place, out);
  if (results.study.contains("files") && results.study["files"].is_object())
    results.study["files"]["folder"] = (place / packed::study).string();
  const Kind* kind = find_kind(results.kind);
  if (!kind)
    throw UsageError(fmt::format("it holds a study of kind {}, which this program does not have", results.kind));
  const std::vector<const CaseRecord*> all = cases_that_march(results);
  const std::vector<const CaseRecord*> chosen = drawn(all, cases_asked(arguments.drawn, all.size()));
  std::optional<StoredStudy> opened;  // a plugin that is missing is told before anything is
  if (!chosen.empty()) opened.emplace(results, arguments.plugins);
  out << fmt::format("{} ({}): {} of {} computed again\n", results.name, results.kind, chosen.size(),
                     counted(all.size(), "case"))
      << other_program(results.environment);
  if (!opened) return exit_done;
  const StoredStudy& stored = *opened;
  const StopSignal signals;
  const AgreementOf agreement(results);
  std::map<Agreement, std::size_t> counts;
  for (const CaseRecord* record : chosen) {
    const CaseRecord again =
        march_again(place / packed::results, *kind, stored, stored.find(record->id), signals.requested());
    std::string text;
    ++counts[agreement(*record, again, text)];
    out << fmt::format("  {}: {}\n", record->id, text);
  }
  const char* verdict = counts[Agreement::no] > 0       ? "not equal"
                        : counts[Agreement::within] > 0 ? "equal within u"
                        : counts[Agreement::digits] > 0 ? "equal to six digits"
                                                        : "bit-equal";
  out << fmt::format("{}: {} to the last bit, {} to six digits, {} within u, {} not\n", verdict,
                     counts[Agreement::bits], counts[Agreement::digits], counts[Agreement::within],
                     counts[Agreement::no]);
  return counts[Agreement::no] > 0 ? exit_some_failed : exit_done;
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  const fs::path inner = fs::weakly_canonical(file), outer = fs::canonical(folder);
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

/// Nothing there, an empty file, or a zip file, which a new one may replace.
bool may_replace(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return true;
  if (!fs::is_regular_file(file, ignored)) return false;
  std::ifstream stream(file, std::ios::binary);
  std::string begins(4, '\0');
  stream.read(begins.data(), static_cast<std::streamsize>(begins.size()));
  return (stream.eof() && stream.gcount() == 0) || begins == "PK\x03\x04";
}

/// NAME of NAME.ricochet.zip, else the name without its last ending. Throws UsageError where that is no other name.
fs::path folder_to_unpack(const fs::path& file) {
  constexpr std::string_view ending = ".ricochet.zip";
  std::string name = file.filename().string();
  if (name.ends_with(ending))
    name.resize(name.size() - ending.size());
  else
    name = file.stem().string();
  std::error_code ignored;
  if (name.empty() || fs::equivalent(name, file, ignored))
    throw UsageError(file.string() + ": its name says no folder; expected one: ricochet unpack FILE DIR");
  return name;
}

}  // namespace

int command_pack(const Arguments& arguments, std::ostream& out) {
  const fs::path folder = arguments.operands.front();
  if (!fs::exists(folder / "results.sqlite"))
    throw UsageError(folder.string() + ": holds no results.sqlite; expected a folder of results");
  if (arguments.out && lies_in(*arguments.out, folder))
    throw UsageError(arguments.out->string() + " lies in the folder that is packed; expected a file outside of it");
  if (arguments.out && !may_replace(*arguments.out))
    throw UsageError(arguments.out->string() + " is there, and no zip file; expected a new file");
  // Nobody writes there meanwhile; where nobody can, nothing is locked.
  std::optional<FolderLock> lock;
  if (::access(folder.c_str(), W_OK) == 0) lock.emplace(folder);
  const AnalysedResults results(read_store(folder));
  const std::size_t cases = results.cases.size();
  const int expected = results.expected_cases;
  const fs::path file = arguments.out.value_or(results.name + ".ricochet.zip");
  const std::string answer = report::index_markdown({{results, ""}});
  // Tables and report are those of the store, whatever lies beside it.
  const TemporaryFolder made("pack");
  write_results(results, made.path());
  for (const auto& item : fs::directory_iterator(folder))
    if (item.path().filename().string().starts_with("results.sqlite"))
      fs::copy_file(item.path(), made.path() / item.path().filename());
  const std::size_t parts = pack_results(made.path(), results, answer, file, program_here());
  out << fmt::format("{}: {}, {} of {}, {}\nSHA-256 {}\n", file.string(), counted(parts, "part"), cases,
                     counted(static_cast<std::size_t>(expected), "case"),
                     size_text(static_cast<double>(fs::file_size(file))), file_sha256(file));
  return exit_done;
}

int command_unpack(const Arguments& arguments, std::ostream& out) {
  const fs::path file = arguments.operands.front();
  const fs::path folder = arguments.operands.size() > 1 ? fs::path(arguments.operands[1]) : folder_to_unpack(file);
  std::error_code ignored;
  if (fs::exists(folder, ignored) && (!fs::is_directory(folder, ignored) || !fs::is_empty(folder, ignored)))
    throw UsageError(folder.string() + " is there, and not an empty folder; expected a new one");
  FolderWriter writer(folder);
  const std::size_t parts = unpack_results(file, writer.place()).size();
  writer.commit();
  out << fmt::format("{}: {}, each as it was packed\nresults: {}\n", folder.string(), counted(parts, "part"),
                     (folder / packed::results).string());
  return exit_done;
}

int command_verify(const Arguments& arguments, std::ostream& out) {
  cases_asked(arguments.drawn, 0);  // a slip there is told first
  return march_apart(arguments, out, [&](std::ostream& to) {
    const fs::path file = arguments.operands.front();
    const TemporaryFolder work("verify");
    const std::vector<std::string> parts = unpack_results(file, work.path());
    to << fmt::format("{}: {}, each as it was packed\nSHA-256 {}\n", file.string(), counted(parts.size(), "part"),
                      file_sha256(file));
    try {
      return compute_again(arguments, parts, work.path(), to);
    } catch (const PointRefused& refused) {
      throw UsageError(refused.what());
    } catch (const Interrupted&) {
      return static_cast<int>(exit_interrupted);
    }
  });
}

}  // namespace ricochet
