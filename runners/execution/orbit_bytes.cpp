#include "runners/execution/orbit_bytes.hpp"

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <type_traits>

namespace ricochet {
namespace {

// One description of an orbit serves both ways.
class Writer {
 public:
  std::string bytes;
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(const T& value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void operator()(const std::string& text) {
    operator()(static_cast<std::uint64_t>(text.size()));
    bytes.append(text);
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(const std::vector<T>& values) {
    operator()(static_cast<std::uint64_t>(values.size()));
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }
};

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  template <class T>
  requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void operator()(T& value) { raw(&value, sizeof value); }
  void operator()(std::string& text) {
    text.resize(count(1));
    raw(text.data(), text.size());
  }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void operator()(std::vector<T>& values) {
    values.resize(count(sizeof(T)));
    raw(values.data(), values.size() * sizeof(T));
  }

 private:
  std::size_t count(std::size_t unit) {
    std::uint64_t value = 0;
    raw(&value, sizeof value);
    if (value > (bytes_.size() - at_) / unit) throw std::runtime_error("a stored orbit is cut short");
    return static_cast<std::size_t>(value);
  }
  void raw(void* out, std::size_t size) {
    if (size > bytes_.size() - at_) throw std::runtime_error("a stored orbit is cut short");
    if (size > 0) std::memcpy(out, bytes_.data() + at_, size);
    at_ += size;
  }
  const std::string& bytes_;
  std::size_t at_ = 0;
};

template <class Archive, class State>
void describe_state(Archive& archive, State& state) {
  archive(state.slots);
  archive(state.efforts);
  archive(state.fastest);
}

template <class Archive, class One>
void describe(Archive& archive, One& orbit) {
  archive(orbit.task);
  archive(orbit.stage);
  archive(orbit.transient_periods);
  archive(orbit.kept_periods);
  archive(orbit.settled);
  archive(orbit.cause);
  archive(orbit.stopped_period);
  archive(orbit.settling.scale);
  archive(orbit.settling.tolerance);
  archive(orbit.settling.longest);
  archive(orbit.settling.ring);
  archive(orbit.settling.repeats);
  archive(orbit.settling.periods);
  archive(orbit.readings.width);
  archive(orbit.readings.values);
  archive(orbit.strobed);
  archive(orbit.points);
  archive(orbit.impacts);
  archive(orbit.impact_counts);
  archive(orbit.contact_steps);
  archive(orbit.most_on_a_side);
  archive(orbit.closed[0]);
  archive(orbit.closed[1]);
  describe_state(archive, orbit.entry);
  describe_state(archive, orbit.now);
}

constexpr std::uint64_t mark = 0x3174696272'0001;  // what the bytes are, and their version

}  // namespace

std::string to_bytes(const MarchedOrbits& marched) {
  Writer writer;
  writer(mark);
  for (const auto* orbits : {&marched.finished, &marched.running}) {
    writer(static_cast<std::uint64_t>(orbits->size()));
    for (const Orbit& orbit : *orbits) describe(writer, orbit);
  }
  return std::move(writer.bytes);
}

MarchedOrbits marched_orbits(const std::string& bytes) {
  Reader reader(bytes);
  std::uint64_t found = 0;
  reader(found);
  if (found != mark) throw std::runtime_error("stored orbits are of another version");
  MarchedOrbits marched;
  for (auto* orbits : {&marched.finished, &marched.running}) {
    std::uint64_t count = 0;
    reader(count);
    for (std::uint64_t i = 0; i < count; ++i) {
      orbits->emplace_back();
      describe(reader, orbits->back());
    }
  }
  return marched;
}

}  // namespace ricochet
