#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <ricochet/contract/errors.hpp>

#include "runners/kinds/all_kinds.hpp"
#include "runners/kinds/kind.hpp"
#include "runners/kinds/trajectory/stop_measures.hpp"
#include "runners/store/record_values.hpp"
#include "runners/table/table_reader.hpp"

namespace ricochet {
namespace {

/// The kinds, and what is asked of all of them together.
struct Registered {
  std::vector<KindPointer> kinds;
  std::vector<MeasureInfo> measures;
  void add(KindPointer kind) {
    measures.insert(measures.end(), kind->measures.begin(), kind->measures.end());
    kinds.push_back(std::move(kind));
  }
};

Registered& registered() {
  static Registered all = [] {
    Registered built_in;
    // A new kind is one more line here.
    for (KindPointer (*make)() : {trajectory_kind, convergence_kind, work_precision_kind, stability_kind,
                                  bifurcation_kind, basins_kind, continuation_kind})
      built_in.add(make());
    return built_in;
  }();
  return all;
}

}  // namespace

CaseRecord Kind::march(const StudyCase&, const Registry&, const std::atomic<bool>&) const {
  throw std::logic_error("a case of kind " + format.name + " is more than one integration");
}

Analysis Kind::analysis(StudyResults& results, const Choices&) const {
  collect_tables(results);
  return {};
}

int Kind::point(const StudyResults&, const PointRequest&, std::ostream&) const {
  throw PointRefused("a study of kind " + format.name + " has no points");
}

const std::vector<KindPointer>& kinds() {
  return registered().kinds;
}

void add_kind(KindPointer kind) {
  if (find_kind(kind->format.name)) throw std::logic_error("there is a kind \"" + kind->format.name + "\" already");
  registered().add(std::move(kind));
}

const Kind* find_kind(const std::string& name) {
  const auto found =
      std::find_if(kinds().begin(), kinds().end(), [&](const KindPointer& kind) { return kind->format.name == name; });
  return found == kinds().end() ? nullptr : found->get();
}

std::vector<const StudyKind*> study_kinds() {
  std::vector<const StudyKind*> formats;
  for (const KindPointer& kind : kinds()) formats.push_back(&kind->format);
  return formats;
}

const std::vector<MeasureInfo>& all_measures() {
  return registered().measures;
}

const MeasureInfo* measure_info(const std::string& name) {
  const auto& all = all_measures();
  const auto found = std::find_if(all.begin(), all.end(), [&](const MeasureInfo& info) { return name == info.name; });
  return found == all.end() ? stop_measure_info(name) : &*found;
}

std::vector<std::string> standing_measures(const std::string& kind) {
  std::vector<std::string> names;
  if (const Kind* known = find_kind(kind); known && known->measures_stand())
    for (const MeasureInfo& info : known->measures)
      if (!info.where_met) names.emplace_back(info.name);
  return names;
}

CaseRecord run_guarded(const CaseRunner& cases, const StudyCase& study_case, const std::atomic<bool>& stop) {
  CaseRecord record;
  const auto fail = [&](Said reason) {
    record = CaseRecord{};
    record.status = Status::failed;
    record.reasons = {std::move(reason)};
  };
  try {
    record = cases.run(study_case, stop);
  } catch (const Interrupted&) {
    throw;
  } catch (const RunError&) {
    throw;
  } catch (const InputError& error) {
    fail(error.pointer().empty() ? error.what() : fmt::format("at {}: {}", error.pointer(), error.what()));
  } catch (const std::bad_alloc&) {
    fail("not enough memory");
  } catch (const std::exception& error) {
    fail(error.what());
  } catch (const Refusal& refusal) {
    fail(refusal.sentence);
  } catch (...) {
    fail("an exception that carries no message");
  }
  record.id = study_case.id;
  record.axes = study_case.axes;
  return record;
}

void collect_tables(StudyResults& results, const std::function<bool(const std::string&)>& left_out) {
  for (const CaseRecord& record : results.cases)
    for (const Table& own : record.tables) {
      if (left_out && left_out(own.name)) continue;
      Table* found = find_table(results.derived, own.name);
      if (!found) found = &results.derived.emplace_back(table_of_cases(results, own));
      append_rows(results, record, own, *found);
    }
}

}  // namespace ricochet
