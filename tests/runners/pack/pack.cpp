// A result in one file: what comes out is what went in, and what is not as it was packed leaves nothing behind.
#include "runners/pack/pack.hpp"

#include <archive.h>
#include <archive_entry.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "runners/pack/sha256.hpp"
#include "runners/pack/zip_file.hpp"
#include "runners/run/analysed_results.hpp"
#include "runners/store/store.hpp"
#include "runners/table/table_reader.hpp"
#include "tests/runners/command/spoken_command.hpp"

namespace command_tests {
namespace {

using ricochet::Sha256;
using ricochet::ZipWriter;

std::string sha256(const std::string& text) {
  Sha256 sum;
  sum.add(text);
  return sum.digits();
}

/// Results of a study that takes no time, in the folder `made`.
void make_results(const Folder& here, const std::string& steps = "[0.01, 0.005]") {
  here.write("rod.json", R"({
    "name": "rod", "kind": "trajectory", "duration": 1, "samples": 10, "step": )" +
                             steps + R"(,
    "ask": [{"value": "energy_end"}],
    "scene": {"structure": {"type": "oscillator", "mass": 1, "stiffness": 1}, "stops": {"upper": 0.1, "at": "tip"},
              "initial": {"velocity": "1"},
              "load": [{"force": {"file": "force.csv", "time": "t", "value": "f"}}]},
    "methods": {"mass": "consistent", "contact": [{"name": "penalty", "stiffness": 1e3}, "signorini"], "time": "newmark"}})");
  here.write("force.csv", "t,f\n0,0\n0.5,0.1\n1,0\n");
  const Outcome run = here.run("run rod.json --out made");
  INFO(run.out << run.err);
  REQUIRE(run.code == 0);
}

using Parts = std::vector<std::pair<std::string, std::string>>;

Parts parts_of(const fs::path& file) {
  Parts parts;
  ricochet::read_zip(file, {[&](const std::string& name) { parts.emplace_back(name, ""); },
                            [&](std::string_view bytes) { parts.back().second += bytes; }, [] {}});
  return parts;
}

void write_parts(const fs::path& file, const Parts& parts) {
  ZipWriter zip(file);
  for (const auto& [name, text] : parts) zip.add(name, text);
  zip.commit();
}

/// A part with a sum of its own in the manifest, as one who knows the format would add it.
void add_part(Parts& parts, const std::string& name, const std::string& text) {
  parts.front().second += sha256(text) + "  " + name + "\n";
  parts.emplace_back(name, text);
}

/// The manifest and, but for `as_it_is`, the description of these parts, as one who knows the format writes them.
void describe(Parts& parts, bool as_it_is = false) {
  using nlohmann::ordered_json;
  std::string sums;
  for (auto& [name, text] : parts) {
    if (name != ricochet::packed::crate || as_it_is) continue;
    ordered_json described = ordered_json::parse(text);
    for (ordered_json& item : described.at("@graph"))
      for (const auto& [part, content] : parts)
        if (item.at("@id") == part && item.contains("sha256")) {
          item["sha256"] = sha256(content);
          item["contentSize"] = std::to_string(content.size());
        }
    text = described.dump(2) + "\n";
  }
  for (const auto& [name, text] : parts)
    if (name != ricochet::packed::sums) sums += sha256(text) + "  " + name + "\n";
  parts.front().second = sums;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& item : fs::directory_iterator(folder)) {
    const std::string name = item.path().filename().string();
    if (name != ".out" && name != ".err") names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

TEST_CASE("pack: SHA-256 gives the digests of FIPS 180-4, in whatever pieces") {
  CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
        "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  CHECK(sha256(std::string(1000000, 'a')) == "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
  for (const std::size_t size : {55, 56, 63, 64, 65, 119, 120, 128}) {
    const std::string text(size, 'x');
    Sha256 pieces;
    for (std::size_t at = 0; at < size; at += 7) pieces.add(std::string_view(text).substr(at, 7));
    CHECK(pieces.digits() == sha256(text));
  }
}

TEST_CASE("pack: a result comes out as it went in, runs again from its study, and is bit-equal") {
  const Folder here;
  make_results(here);
  const Outcome first = here.run("pack made"), second = here.run("pack made --out again.zip", "TZ=Asia/Tokyo");
  INFO(first.out << first.err << second.err);
  REQUIRE(first.code == 0);
  CHECK_THAT(first.out, Contains("rod.ricochet.zip: ") && Contains("4 of 4 cases") && Contains("SHA-256 "));
  CHECK(read(here / "rod.ricochet.zip") == read(here / "again.zip"));

  const Outcome unpacked = here.run("unpack rod.ricochet.zip");
  INFO(unpacked.out << unpacked.err);
  REQUIRE(unpacked.code == 0);
  for (const auto& item : fs::recursive_directory_iterator(here / "made"))
    if (item.is_regular_file())
      CHECK(read(item.path()) == read(here / "rod" / "results" / item.path().lexically_relative(here / "made")));
  CHECK(read(here / "rod/study/force.csv") == read(here / "force.csv"));
  CHECK_THAT(read(here / "rod/answer.md"), Contains("rod"));
  if (std::system("command -v sha256sum >/dev/null") == 0)
    CHECK(std::system(("cd '" + (here / "rod").string() + "' && sha256sum --quiet -c manifest-sha256.txt").c_str()) ==
          0);

  const auto crate = nlohmann::json::parse(read(here / "rod/ro-crate-metadata.json"));
  std::size_t files = 0;
  for (const auto& item : crate.at("@graph")) {
    if (item.at("@type") != "File") continue;
    ++files;
    CHECK(item.at("sha256") == sha256(read(here / "rod" / item.at("@id").get<std::string>())));
  }
  CHECK(files + 2 == parts_of(here / "rod.ricochet.zip").size());
  CHECK_THAT(crate.dump(), Contains("contract") && Contains("plugin mass.so") && Contains("lanes"));

  // Its study runs where it lies; the force is the file beside it.
  const Outcome run = here.run("run rod/study/study.json --out elsewhere");
  INFO(run.out << run.err);
  CHECK(run.code == 0);
  CHECK_THAT(here.run("compare made elsewhere").out, Contains("cases: 4 in both"));

  fs::remove(here / "force.csv");  // the pack has its own
  const Outcome verified = here.run("verify rod.ricochet.zip --cases all");
  INFO(verified.out << verified.err);
  CHECK(verified.code == 0);
  CHECK_THAT(verified.out, Contains("4 of 4 cases computed again") && Contains("bit-equal: 4 to the last bit"));
  CHECK_THAT(here.run("verify rod.ricochet.zip").out, Contains("3 of 4 cases"));
  CHECK_THAT(here.run("verify rod.ricochet.zip --cases 0").out, !Contains("bit-equal"));
  const Outcome wrong = here.run("verify rod.ricochet.zip --cases many");
  CHECK(wrong.code == 2);
  CHECK_THAT(wrong.err, Contains("expected a number of cases, or all"));
}

namespace {

/// What `verify` says of all cases of these results, which are those in `made` with other numbers.
Outcome verified(const Folder& here, const ricochet::StudyResults& results) {
  using namespace ricochet;
  const fs::path folder = here / "changed", file = here / "changed.zip";
  fs::remove_all(folder);
  fs::copy(here / "made", folder, fs::copy_options::recursive);
  std::vector<ExpectedCase> expected;
  for (const CaseRecord& record : results.cases) expected.push_back({record.id, "as made"});
  {
    Store store(folder, true);
    store.begin(results, expected);
    store.save_environment(results.environment);
    store.save(results.cases);
  }
  fs::remove(file);
  pack_results(folder, read_store(folder), "", file);
  return here.run("verify changed.zip --cases all");
}

double& measure_of(ricochet::CaseRecord& record, const std::string& wanted) {
  for (auto& [name, value] : record.measures)
    if (name == wanted) return value;
  throw std::runtime_error("no measure " + wanted);
}

}  // namespace

TEST_CASE("verify: a measure that is off is equal within u up to what step and mesh leave of it, and no further") {
  using namespace ricochet;
  const Folder here;
  make_results(here);
  // u over the value, of the first measure that has one in these results, and the case of the method's finest step.
  struct Known {
    std::string id, measure;
    double share = 0;
  };
  const auto first_known = [](StudyResults results) {
    const AnalysedResults all = with_tables(std::move(results));
    const Table* limits = find_table(all.derived, "limits");
    REQUIRE(limits != nullptr);
    const TableReader rows(*limits);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const auto value = rows.number(r, "value"), u = rows.number(r, "u");
      if (value && u && *value != 0 && *u != 0)
        return Known{rows.text(r, "case"), rows.text(r, "measure"), *u / std::abs(*value)};
    }
    return Known{};
  };
  const Known known = first_known(read_store(here / "made"));
  REQUIRE(known.share > 0);
  const auto changed = [&](const std::string& measure, double factor) {
    StudyResults results = read_store(here / "made");
    for (CaseRecord& record : results.cases)
      if (record.id == known.id) measure_of(record, measure) *= factor;
    return results;
  };
  const Outcome same = verified(here, changed(known.measure, 1));
  INFO(same.out << same.err);
  CHECK(same.code == 0);
  CHECK_THAT(same.out, Contains("\nbit-equal: 4 to the last bit, 0 to six digits, 0 within u, 0 not\n"));
  // A stored value that is off does not widen the u that it is held against.
  for (const double off : {0.01, 0.3, -0.3, 0.9, -0.9, 1.1, -1.1, 4.0, -4.0}) {
    const bool inside = std::abs(off) <= 1;
    const Outcome outcome = verified(here, changed(known.measure, 1 + off * known.share));
    INFO(off << " " << known.measure << " " << known.share << outcome.out << outcome.err);
    CHECK(outcome.code == (inside ? 0 : 3));
    CHECK_THAT(outcome.out,
               Contains(known.id + (inside ? ": equal within u: " : ": not equal:")) &&
                   Contains(inside ? "\nequal within u: 3 to the last bit, 0 to six digits, 1 within u, 0 not\n"
                                   : "\nnot equal: 3 to the last bit, 0 to six digits, 0 within u, 1 not\n"));
    CHECK_THAT(outcome.out, !Contains("no u"));
  }
  // What both steps have alike has a u of round-off.
  const Outcome start = verified(here, changed("energy_start", 1.01));
  INFO(start.out << start.err);
  CHECK(start.code == 3);
  CHECK_THAT(start.out, Contains("energy_start is 0.5, stored is 0.505; u is "));
}

TEST_CASE("verify: what has no u agrees to six digits, curves and tables too, or is not equal") {
  using namespace ricochet;
  const Folder here;
  make_results(here, "0.005");  // of a single step nothing has a u
  const StudyResults made = read_store(here / "made");
  const auto changed = [&](const std::function<void(CaseRecord&)>& change) {
    StudyResults results = made;
    change(results.cases.front());
    return verified(here, results);
  };
  const auto expect = [](const Outcome& outcome, int code, const std::string& said) {
    INFO(outcome.out << outcome.err);
    CHECK(outcome.code == code);
    CHECK_THAT(outcome.out, Contains(said));
  };
  const std::string digits = "equal to six digits: 1 to the last bit, 1 to six digits, 0 within u, 0 not\n",
                    none = "not equal: 1 to the last bit, 0 to six digits, 0 within u, 1 not\n";
  for (const std::string name : {"energy_end", "impulse", "largest_tip_displacement"}) {
    CAPTURE(name);
    CaseRecord first = made.cases.front();
    REQUIRE(measure_of(first, name) != 0);
    expect(changed([&](CaseRecord& one) { measure_of(one, name) *= 1 + 0.9e-6; }), 0, digits);
    expect(changed([&](CaseRecord& one) { measure_of(one, name) *= 1 + 1.1e-6; }), 3, none);
    expect(changed([&](CaseRecord& one) { measure_of(one, name) *= 1 + 1.1e-6; }), 3, "the study says no u of it");
  }
  expect(changed([](CaseRecord& one) { measure_of(one, "impacts") += 1; }), 3, "impacts is ");
  // Round-off of a sum that cancels is beside what cancels.
  expect(changed([](CaseRecord& one) { measure_of(one, "balance_residual") += 1e-16; }), 0, digits);
  expect(changed([](CaseRecord& one) { measure_of(one, "balance_residual") += 1e-9; }), 3, "balance_residual is ");
  expect(
      changed([](CaseRecord& one) { std::erase_if(one.measures, [](const auto& m) { return m.first == "impulse"; }); }),
      3, ", and is not stored");
  expect(changed([](CaseRecord& one) { one.measures.emplace_back("window_power", 1); }), 3, ", and is not measured");
  expect(changed([](CaseRecord& one) { one.steps += 1; }), 3, "it takes 200 steps, stored are 201");
  const auto curve = [&](double factor) {
    return changed([&](CaseRecord& one) {
      REQUIRE(one.curve.columns.size() > 1);
      std::vector<double> numbers = one.curve.columns.back().get();
      *std::max_element(numbers.begin(), numbers.end()) *= factor;
      one.curve.columns.back() = Series(numbers);
    });
  };
  expect(curve(1 + 0.9e-6), 0, digits);
  expect(curve(1 + 1e-3), 3, "the curve's ");
}

TEST_CASE("pack: what is not a whole packed result is refused with its cause, and leaves nothing") {
  const Folder here;
  make_results(here);
  REQUIRE(here.run("pack made").code == 0);
  const std::string whole = read(here / "rod.ricochet.zip");
  const Parts parts = parts_of(here / "rod.ricochet.zip");
  const auto refused = [&](const std::string& cause) {
    const std::vector<std::string> before = names_in(here / "");
    for (const char* words : {"verify bad.zip", "unpack bad.zip new"}) {
      const Outcome outcome = here.run(words);
      INFO(words << "\n" << outcome.out << outcome.err);
      CHECK(outcome.code == 2);
      CHECK(outcome.out.empty());
      CHECK_THAT(outcome.err, StartsWith("ricochet: bad.zip: ") && Contains(cause));
    }
    CHECK(names_in(here / "") == before);
  };
  for (const std::size_t size : {std::size_t{0}, std::size_t{10}, whole.size() / 2, whole.size() - 30}) {
    here.write("bad.zip", whole.substr(0, size));
    refused("no whole zip file");
  }
  here.write("bad.zip", "not a zip file at all");
  refused("no whole zip file");

  const auto changed = [&](const std::function<void(Parts&)>& change, const std::string& cause) {
    Parts other = parts;
    change(other);
    fs::remove(here / "bad.zip");
    write_parts(here / "bad.zip", other);
    refused(cause);
  };
  changed([](Parts& all) { all.back().second += " "; }, "is not as it was packed");
  changed([](Parts& all) { all.pop_back(); }, "is missing");
  changed([](Parts& all) { all.erase(all.begin()); }, "has no part manifest-sha256.txt");
  changed([](Parts& all) { all.emplace_back("results/more.csv", "a\n"); }, "was not packed");
  changed([](Parts& all) { all.front().second += "half a line\n"; }, "has a line that is none");
  changed([](Parts& all) { all = {{ricochet::packed::sums, ""}}; }, "has no part ro-crate-metadata.json");
  for (const char* name : {"study/study.json", "results/report.html", "results/dictionary.csv"})
    changed(
        [&](Parts& all) {
          std::erase_if(all, [&](const auto& part) { return part.first == name; });
          describe(all);
        },
        std::string("has no part ") + name);
  changed([](Parts& all) { add_part(all, "notes/of-mine.txt", "x"); }, "\"notes/of-mine.txt\" is none that a packed");
  changed([](Parts& all) { add_part(all, "study/more.csv", "x"); }, "does not describe \"study/more.csv\"");
  changed(
      [](Parts& all) {
        for (auto& [name, text] : all)
          if (name == ricochet::packed::crate) text = "garbage";
        describe(all, true);
      },
      "describes nothing");
  // Whoever writes the manifest can name what is not allowed.
  for (const char* name : {"../climbs", "results/../../climbs", "/tmp/absolute", "a//b", "./a", "a\\b", "line\nbreak"})
    changed([&](Parts& all) { add_part(all, name, "x"); }, "\"");
  changed([](Parts& all) { all.emplace_back("results/" + std::string(300, 'a'), "x"); }, "longer than");
  changed(
      [](Parts& all) {
        std::string deep = "results";
        for (int i = 0; i < 100; ++i) deep += "/" + std::string(50, 'a');
        all.emplace_back(deep, "x");
      },
      "longer than");
  changed([](Parts& all) { all.emplace_back("line\nbreak", "x"); }, "\"line<U+000A>break\" is no plain name");
  changed([](Parts& all) { add_part(all, "study/study.json", "{}"); }, "stands twice");
  changed([](Parts& all) { add_part(all, "results/zeros", std::string(300000000, '\0')); }, "times as large");
  CHECK_FALSE(fs::exists(here / "climbs"));

  // A link that would lead a later part out of the folder.
  fs::remove(here / "bad.zip");
  archive* zip = archive_write_new();
  archive_write_set_format_zip(zip);
  archive_write_open_filename(zip, (here / "bad.zip").c_str());
  archive_entry* entry = archive_entry_new();
  archive_entry_set_pathname(entry, "results");
  archive_entry_set_filetype(entry, AE_IFLNK);
  archive_entry_set_symlink(entry, "/tmp");
  archive_entry_set_perm(entry, 0777);
  archive_write_header(zip, entry);
  archive_entry_free(entry);
  archive_write_free(zip);
  refused("is a link, a folder or a device");
}

TEST_CASE("pack: bytes that change at random are told, or change nothing that is packed") {
  const Folder here;
  make_results(here);
  REQUIRE(here.run("pack made").code == 0);
  const std::string whole = read(here / "rod.ricochet.zip");
  const Parts parts = parts_of(here / "rod.ricochet.zip");
  std::mt19937 random(1);
  int told = 0;
  constexpr int tries = 60;
  for (int n = 0; n < tries; ++n) {
    std::string bytes = whole;
    bytes[random() % bytes.size()] ^= static_cast<char>(1 + random() % 255);
    here.write("bad.zip", bytes);
    fs::remove_all(here / "place");
    fs::create_directory(here / "place");
    try {
      ricochet::unpack_results(here / "bad.zip", here / "place");
      for (const auto& [name, text] : parts) CHECK(read(here / "place" / name) == text);
    } catch (const std::exception& error) {
      CHECK_THAT(error.what(), Contains("bad.zip: "));
      ++told;
    }
  }
  CHECK(told > tries / 2);
}

TEST_CASE("pack: another result than the stored one is not equal, and says so with exit code 3") {
  const Folder here;
  make_results(here);
  REQUIRE(here.run("pack made").code == 0);
  Parts parts = parts_of(here / "rod.ricochet.zip");
  // The force of another study, with sums that fit.
  for (auto& [name, text] : parts)
    if (name == "study/force.csv") text = "t,f\n0,0\n0.5,0.2\n1,0\n";
  describe(parts);
  write_parts(here / "other.zip", parts);
  const Outcome other = here.run("verify other.zip --cases all");
  INFO(other.out << other.err);
  // The study knows its files by their digests.
  CHECK(other.code == 2);
  CHECK_THAT(other.err, Contains("other.zip: study/force.csv is not what its store says"));
}

TEST_CASE("verify: tables, answer and report that the store does not say are refused, though their sums fit") {
  const Folder here;
  make_results(here);
  REQUIRE(here.run("pack made").code == 0);
  const Parts whole = parts_of(here / "rod.ricochet.zip");
  const auto verified_with = [&](const std::string& changed, const std::function<void(std::string&)>& change) {
    Parts parts = whole;
    for (auto& [name, text] : parts)
      if (name == changed) change(text);
    describe(parts, changed == ricochet::packed::crate);
    fs::remove(here / "other.zip");
    write_parts(here / "other.zip", parts);
    return here.run("verify other.zip --cases 0");
  };
  const Outcome same = verified_with("", [](std::string&) {});
  INFO(same.out << same.err);
  CHECK(same.code == 0);
  CHECK_THAT(same.out, Contains("\nstudy, tables, answer, report and description are what the store says\n"));
  for (const std::string part :
       {"results/cases.csv", "results/limits.csv", "answer.md", "results/report.html", "results/study.json",
        "study/study.json", "study/force.csv", "ro-crate-metadata.json"}) {
    const Outcome other = verified_with(part, [](std::string& text) { text.back() = ' '; });
    INFO(other.out << other.err);
    CHECK(other.code == 2);
    CHECK_THAT(other.err, Contains("other.zip: " + part + " is not what its store says"));
  }
  Parts more = whole;
  add_part(more, "results/more.csv", "case\n");
  write_parts(here / "more.zip", more);
  const Outcome added = here.run("verify more.zip --cases 0");
  CHECK(added.code == 2);
  CHECK_THAT(added.err, Contains("more.zip: ro-crate-metadata.json does not describe \"results/more.csv\""));
  // Of what it names, and of what it says beside.
  const Outcome study =
      verified_with("study/study.json", [](std::string& text) { text.replace(text.find("0.005"), 5, "0.004"); });
  CHECK(study.code == 2);
  CHECK_THAT(study.err, Contains("other.zip: study/study.json is not what its store says"));
  const Outcome crate = verified_with(ricochet::packed::crate, [](std::string& text) {
    text.replace(text.find("\"startTime\""), 11, "\"stopsTime\"");
  });
  CHECK(crate.code == 2);
  CHECK_THAT(crate.err, Contains("other.zip: ro-crate-metadata.json is not what its store says"));
  // Another program may write other digits.
  const Outcome program = verified_with(ricochet::packed::crate, [](std::string& text) {
    const std::string packer = "\"#packer\"", name = "\"ricochet ";
    const std::size_t at = text.find(name, text.find(packer));
    REQUIRE(at != std::string::npos);
    text.replace(at, name.size(), "\"ricochet 9.");
    text.replace(text.find(name, at + 1), name.size(), "\"ricochet 9.");
  });
  INFO(program.out << program.err);
  CHECK(program.code == 0);
  CHECK_THAT(program.out, Contains("are not compared with the store: another program packed them") &&
                              Contains("\nthe study says what the store says\n"));
}

TEST_CASE("verify: of what another program packed, a study that differs is told and not judged") {
  const Folder here;
  make_results(here);
  REQUIRE(here.run("pack made").code == 0);
  Parts parts = parts_of(here / "rod.ricochet.zip");
  for (auto& [name, text] : parts) {
    if (name == "study/study.json") text.replace(text.find("0.005"), 5, "0.004");
    if (name != ricochet::packed::crate) continue;
    const std::size_t at = text.find("\"ricochet ", text.find("\"#packer\""));
    REQUIRE(at != std::string::npos);
    text.replace(at, 10, "\"ricochet 9.");
    text.replace(text.find("\"ricochet ", at + 1), 10, "\"ricochet 9.");
  }
  describe(parts);
  write_parts(here / "other.zip", parts);
  const Outcome told = here.run("verify other.zip --cases 0");
  INFO(told.out << told.err);
  CHECK(told.code == 0);
  CHECK_THAT(told.out, Contains("the study is not, as this program reads it, that of the store"));
}

TEST_CASE("verify: a method that no plugin here provides is a missing plugin, however near another name is") {
  const Folder here;
  make_results(here);
  ricochet::StudyResults results = ricochet::read_store(here / "made");
  for (const std::string name : {"newmarks", "my-scheme"}) {
    CAPTURE(name);
    results.study["methods"]["time"][0]["name"] = name;
    const Outcome outcome = verified(here, results);
    INFO(outcome.out << outcome.err);
    CHECK(outcome.code == 4);
    CHECK_THAT(outcome.err,
               Contains("at /methods/time") && Contains("no plugin provides the time scheme \"" + name + "\""));
    CHECK_THAT(outcome.out, !Contains("computed again"));
    CHECK(here.run("case changed " + results.cases.front().id).code == 4);
  }
}

TEST_CASE("pack: tables and report are those of the store, whatever lies beside it") {
  const Folder here;
  make_results(here);
  REQUIRE(here.run("pack made --out whole.zip").code == 0);
  here.write("made/cases.csv", "case,impulse\nnobody,1\n");
  fs::remove(here / "made/report.html");
  here.write("made/notes-of-mine.txt", "not ours");
  const Outcome packed = here.run("pack made --out again.zip");
  INFO(packed.err);
  REQUIRE(packed.code == 0);
  CHECK(read(here / "again.zip") == read(here / "whole.zip"));
  REQUIRE(here.run("unpack whole.zip told").code == 0);
  CHECK_THAT(read(here / "told/ro-crate-metadata.json"), Contains("startTime") && !Contains("endTime"));
}

TEST_CASE("pack: a folder that cannot be packed is refused with its cause") {
  const Folder here;
  make_results(here);
  here.write("force.csv", "t,f\n0,0\n1,9\n");
  const Outcome changed = here.run("pack made");
  CHECK(changed.code == 2);
  CHECK_THAT(changed.err, Contains("force.csv has changed since the study ran"));
  CHECK_FALSE(fs::exists(here / "rod.ricochet.zip"));
  fs::create_directory(here / "empty");
  CHECK_THAT(here.run("pack empty").err, Contains("expected a folder of results"));
  CHECK(here.run("unpack nowhere.zip").code == 2);
  fs::create_directory(here / "full");
  here.write("full/file", "x");
  CHECK_THAT(here.run("unpack nowhere.zip full").err, Contains("not an empty folder"));
}

TEST_CASE("pack: nothing but a zip file is replaced, and nothing of the folder that is packed") {
  const Folder here;
  make_results(here);
  here.write("table.csv", "mine");
  for (const char* file : {"table.csv", "made"}) {
    const Outcome kept = here.run(std::string("pack made --out ") + file);
    INFO(kept.err);
    CHECK(kept.code == 2);
  }
  CHECK(read(here / "table.csv") == "mine");
  const std::string cases = read(here / "made/cases.csv");
  for (const char* file : {"made/cases.csv", "made/new.zip", "made/../made/curves/../new.zip"}) {
    const Outcome inside = here.run(std::string("pack made --out ") + file);
    CHECK(inside.code == 2);
    CHECK_THAT(inside.err, Contains("lies in the folder that is packed"));
  }
  CHECK(read(here / "made/cases.csv") == cases);
  here.write("empty", "");
  for (int time = 0; time < 2; ++time) CHECK(here.run("pack made --out empty").code == 0);
}

TEST_CASE("unpack: the folder is the name of the file without its ending, and never the file") {
  const Folder here;
  make_results(here);
  REQUIRE(here.run("pack made --out m.zip").code == 0);
  CHECK(here.run("unpack m.zip").code == 0);
  CHECK(fs::exists(here / "m/results/results.sqlite"));
  fs::copy_file(here / "m.zip", here / "plain");
  fs::copy_file(here / "m.zip", here / ".ricochet.zip");
  for (const char* file : {"plain", ".ricochet.zip"}) {
    const Outcome none = here.run(std::string("unpack ") + file);
    CHECK(none.code == 2);
    CHECK_THAT(none.err, Contains("its name says no folder"));
  }
  for (const char* words : {"unpack m.zip ''", "unpack ''", "verify ''", "report ''", "run ''", "describe ''"}) {
    const Outcome empty = here.run(words);
    INFO(words << empty.err);
    CHECK(empty.code == 2);
    CHECK_THAT(empty.err, Contains("was given an empty argument"));
  }
}

TEST_CASE("pack: a part that is the folder of another is refused, and a part that is named twice") {
  const Folder here;
  make_results(here);
  REQUIRE(here.run("pack made").code == 0);
  const Parts packed = parts_of(here / "rod.ricochet.zip");
  for (const bool inner_first : {false, true}) {
    Parts parts = packed;
    add_part(parts, inner_first ? "results/own/x" : "results/own", "1");
    add_part(parts, inner_first ? "results/own" : "results/own/x", "2");
    write_parts(here / "both.zip", parts);
    const Outcome both = here.run("verify both.zip");
    CHECK(both.code == 2);
    CHECK_THAT(both.err, Contains("is a file, and the folder of another"));
  }
  Parts twice = packed;
  twice.front().second += twice.front().second.substr(0, twice.front().second.find('\n') + 1);
  write_parts(here / "twice.zip", twice);
  const Outcome named = here.run("verify twice.zip");
  CHECK(named.code == 2);
  CHECK_THAT(named.err, Contains("twice"));
}

TEST_CASE("pack: names beyond ASCII are marked as UTF-8 and read as such") {
  const Folder here;
  const std::string name = "study/donn\u00e9es/sol.csv";
  write_parts(here / "names.zip", {{name, "x"}, {"plain", "y"}});
  const Parts read = parts_of(here / "names.zip");
  REQUIRE(read.size() == 2);
  CHECK(read.front().first == name);
  // The flag of the header: bit 11 of the two bytes behind signature and version.
  std::ifstream file(here / "names.zip", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  REQUIRE(bytes.size() > 8);
  CHECK((static_cast<unsigned char>(bytes[7]) & 0x08) != 0);
}

}  // namespace command_tests
