#include "runners/kinds/continuation/branch_checkpoints.hpp"

#include <cereal/archives/binary.hpp>
#include <cereal/types/complex.hpp>
#include <cereal/types/map.hpp>
#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <sstream>

#include "runners/march/seconds.hpp"

// Vectors as their numbers.
namespace cereal {

template <class Archive>
void save(Archive& archive, const Eigen::VectorXd& x) {
  archive(std::vector<double>(x.begin(), x.end()));
}

template <class Archive>
void load(Archive& archive, Eigen::VectorXd& x) {
  std::vector<double> numbers;
  archive(numbers);
  x = Eigen::Map<const Eigen::VectorXd>(numbers.data(), static_cast<Eigen::Index>(numbers.size()));
}

}  // namespace cereal

namespace ricochet {

// Of what a branch consists, for those who write it as bytes.

template <class Archive>
void serialize(Archive& archive, SetPoint& point) {
  archive(point.stage, point.point, point.upper);
}

template <class Archive>
void serialize(Archive& archive, SetChange& change) {
  archive(change.step, change.row, change.closes, change.upper);
}

template <class Archive>
void serialize(Archive& archive, CornerRoots& roots) {
  archive(roots.outside.total, roots.outside.above, roots.outside.below, roots.outside.pairs, roots.real, roots.modulus,
          roots.angle, roots.product);
}

template <class Archive>
void serialize(Archive& archive, BranchCorner& corner) {
  auto& [parameter, arc, tip, way, runs, held, shortest, raw, smooth, leading, change, residual, rebounds, placed,
         slowest] = corner;
  archive(parameter, arc, tip, way, runs, held, shortest, raw, smooth, leading, change, residual, rebounds, placed,
          slowest);
}

template <class Archive>
void serialize(Archive& archive, MarkedOrbit& mark) {
  auto& [parameter, arc, tip, corner, x, leading, outside] = mark;
  archive(parameter, arc, tip, corner, x, leading, outside.total, outside.above, outside.below, outside.pairs);
}

template <class Archive>
void serialize(Archive& archive, BranchTrace& trace) {
  auto& [corners, states, stride, marks, ties, rebounds, ends, end] = trace;
  archive(corners, states, stride, marks, ties, rebounds, ends, end);
}

template <class Archive>
void serialize(Archive& archive, BranchState& state) {
  auto& [x, parameter, sets, along, parameter_along, change, arc, pieces, step, orientation, begins] = state;
  archive(x, parameter, sets, along, parameter_along, change, arc, pieces, step, orientation, begins);
}

template <class Archive>
void serialize(Archive& archive, KeptBranch& kept) {
  archive(kept.trace, kept.entry, kept.first);
}

namespace {

constexpr int branches_version = 7;
constexpr double keep_interval = 2;  // s

struct KeptWithSets {
  std::vector<ContactSet> sets;
  KeptBranch branch;
};

KeptWithSets kept_branch(const std::string& bytes) {
  std::istringstream in(bytes);
  cereal::BinaryInputArchive archive(in);
  int written = 0;
  archive(written);
  if (written != branches_version) throw std::runtime_error("a branch of another version");
  KeptWithSets kept;
  archive(kept.sets, kept.branch);
  return kept;
}

}  // namespace

std::optional<KeptBranch> BranchCheckpoints::find(const std::string& name, SetSteps* sets) {
  auto kept = recall(store_, key_of(name), kept_branch);
  if (!kept) return std::nullopt;
  names_.insert(name);
  std::vector<int> numbers;
  for (const ContactSet& set : kept->sets) numbers.push_back(sets->number(set));
  for (SetSequence* sequence : {&kept->branch.entry.sets, &kept->branch.first})
    for (int& number : *sequence) number = numbers.at(static_cast<std::size_t>(number));
  return std::move(kept->branch);
}

KeptBranch kept(const BranchRun& run) {
  return {run.trace(), run.entry(), run.first_sets()};
}

KeptBranch kept(const StepFollower& run) {
  return {run.trace(), run.state(), {}};
}

bool BranchCheckpoints::due() const {
  return seconds_since(saved_) >= keep_interval;
}

void BranchCheckpoints::keep(const std::string& name, const KeptBranch& branch, const SetSteps* sets) {
  if (!store_.keep) return;
  std::vector<ContactSet> known;
  for (int number = 0; sets && number < sets->count(); ++number) known.push_back((*sets)[number].closed);
  std::ostringstream out;
  {
    cereal::BinaryOutputArchive archive(out);
    archive(branches_version, known, branch);
  }
  store_.keep(key_of(name), out.str());
  names_.insert(name);
  saved_ = std::chrono::steady_clock::now();
}

void BranchCheckpoints::forget() {
  for (const std::string& name : names_) store_.keep(key_of(name), "");
  names_.clear();
}

}  // namespace ricochet
