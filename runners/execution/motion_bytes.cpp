#include "runners/execution/motion_bytes.hpp"

#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace ricochet {
namespace {

class Writer {
 public:
  void number(double value) { raw(&value, sizeof value); }
  void count(std::size_t value) {
    const auto wide = static_cast<std::uint64_t>(value);
    raw(&wide, sizeof wide);
  }
  void text(const std::string& value) {
    count(value.size());
    raw(value.data(), value.size());
  }
  void numbers(const std::vector<double>& values) {
    count(values.size());
    raw(values.data(), values.size() * sizeof(double));
  }
  std::string bytes;

 private:
  void raw(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
};

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  double number() {
    double value = 0;
    raw(&value, sizeof value);
    return value;
  }
  std::size_t count(std::size_t unit) {
    std::uint64_t value = 0;
    raw(&value, sizeof value);
    if (value > (bytes_.size() - at_) / unit) throw std::runtime_error("a stored reference is cut short");
    return static_cast<std::size_t>(value);
  }
  std::string text() {
    std::string value(count(1), ' ');
    raw(value.data(), value.size());
    return value;
  }
  std::vector<double> numbers() {
    std::vector<double> values(count(sizeof(double)));
    raw(values.data(), values.size() * sizeof(double));
    return values;
  }

 private:
  void raw(void* out, std::size_t size) {
    if (size > bytes_.size() - at_) throw std::runtime_error("a stored reference is cut short");
    if (size > 0) std::memcpy(out, bytes_.data() + at_, size);
    at_ += size;
  }
  const std::string& bytes_;
  std::size_t at_ = 0;
};

// The vectors of a motion, in the order in which they are stored.
template <class Motion, class Act>
void each_series(Motion& motion, Act act) {
  for (auto* series : {&motion.tip, &motion.tip_velocity, &motion.energy, &motion.impulse, &motion.displacement,
                       &motion.strain, &motion.velocity})
    act(*series);
}

void write(Writer& writer, const SampledMotion& motion) {
  each_series(motion, [&](const std::vector<double>& series) { writer.numbers(series); });
  writer.count(motion.events.size());
  for (const ContactEvent& event : motion.events)
    for (const double value : {event.time, static_cast<double>(event.side), event.begins ? 1.0 : 0.0, event.velocity})
      writer.number(value);
}

SampledMotion read(Reader& reader) {
  SampledMotion motion;
  each_series(motion, [&](std::vector<double>& series) { series = reader.numbers(); });
  motion.events.resize(reader.count(4 * sizeof(double)));
  for (ContactEvent& event : motion.events) {
    event.time = reader.number();
    event.side = reader.number() < 0 ? -1 : 1;
    event.begins = reader.number() != 0;
    event.velocity = reader.number();
  }
  return motion;
}

}  // namespace

std::string to_bytes(const ReferenceMotion& motion) {
  Writer writer;
  write(writer, motion.motion);
  write(writer, motion.coarser);
  writer.text(motion.how);
  writer.count(motion.notes.size());
  for (const std::string& note : motion.notes) writer.text(note);
  return writer.bytes;
}

ReferenceMotion motion_from_bytes(const std::string& bytes) {
  Reader reader(bytes);
  ReferenceMotion motion;
  motion.motion = read(reader);
  motion.coarser = read(reader);
  motion.how = reader.text();
  motion.notes.resize(reader.count(sizeof(double)));
  for (std::string& note : motion.notes) note = reader.text();
  return motion;
}

}  // namespace ricochet
