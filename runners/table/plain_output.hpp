#pragma once
#include <cstddef>
#include <ostream>
#include <streambuf>
#include <string>

namespace ricochet {

/// While it lives, what is written to a stream arrives as plain_text(): no text of a study, a plan or a plugin steers a
/// terminal.
class PlainOutput : std::streambuf {
 public:
  explicit PlainOutput(std::ostream& stream);
  ~PlainOutput() override;
  PlainOutput(const PlainOutput&) = delete;
  PlainOutput& operator=(const PlainOutput&) = delete;

 private:
  int_type overflow(int_type c) override;
  std::streamsize xsputn(const char* text, std::streamsize count) override;
  int sync() override;
  /// Hands on what is whole: the bytes of a character may come one by one.
  bool hand_on(std::size_t count);

  std::ostream& stream_;
  std::streambuf* const target_;
  std::string kept_;
};

}  // namespace ricochet
