#include <fmt/format.h>

#include <new>
#include <ricochet/contract/errors.hpp>

#include "runners/kinds/kind.hpp"

namespace ricochet {

CaseRecord run_guarded(const CaseRunner& cases, const StudyCase& study_case, const std::atomic<bool>& stop) {
  CaseRecord record;
  const auto fail = [&](std::string reason) {
    record = CaseRecord{};
    record.status = "failed";
    record.reason = std::move(reason);
  };
  try {
    record = cases.run(study_case, stop);
  } catch (const Interrupted&) {
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

}  // namespace ricochet
