#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "runners/march/block_service.hpp"
#include "runners/store/record.hpp"

/// \file
/// What coordinator and worker send each other, as bytes of this machine: both are the same program.
namespace ricochet {

/// What a worker opens before anything else.
struct WorkerStudy {
  std::string study;                 ///< resolved, as JSON
  std::vector<std::string> plugins;  ///< libraries beside the program's own
  double memory = 0;                 ///< bytes of address space that it may take; 0: no limit
  int width = 1;                     ///< blocks that are marched at one time, by all workers together
  std::string arithmetic;            ///< digest of the coordinator's
};

/// That it did, and with what: equal for equal programs, plugins and studies.
struct WorkerReady {
  std::string identity, arithmetic;
  std::string failure, pointer;  ///< why it could not, and where in the study; "" where it could
};

/// One case to be planned, run or timed.
struct CaseOrder {
  std::string id;
  double budget = 0;  ///< s that a call of a plugin's function may last
  int share = 1;      ///< see BlockService
};

/// A block of a case, to be marched by another worker than the one that runs the case.
struct BlockRequest {
  std::string id, order;
  double budget = 0;  ///< s that a call of a plugin's function may last; set by the coordinator
};

/// What became of it: a value, or what was thrown.
struct CaseAnswer {
  CaseRecord record;           ///< of a run, without axes
  double seconds = 0;          ///< predicted or timed
  double processor = 0;        ///< s that the timing took in all
  bool found = false;          ///< whether there is a time
  std::string error, pointer;  ///< of an exception; `record` is then empty
};

/// A call of a plugin's function that did not return.
struct GivenUp {
  std::string plugin, function;
  double budget = 0;
};

/// A key of the store with what is to be kept there; or a question, without.
struct ShelfMessage {
  std::string key, content;
};

std::string to_bytes(const WorkerStudy& message);
std::string to_bytes(const WorkerReady& message);
std::string to_bytes(const CaseOrder& message);
std::string to_bytes(const BlockRequest& message);
std::string to_bytes(const BlockStatus& message);
std::string to_bytes(const CaseAnswer& message);
std::string to_bytes(const GivenUp& message);
std::string to_bytes(const ShelfMessage& message);
std::string to_bytes(const CaseRecord& record);

/// Bytes that are no message: whoever sent them is not to be believed any more.
class NoMessage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The message that these bytes are. Throws NoMessage for others.
template <class T>
T message_from(const std::string& bytes);
extern template WorkerStudy message_from(const std::string&);
extern template WorkerReady message_from(const std::string&);
extern template CaseOrder message_from(const std::string&);
extern template BlockRequest message_from(const std::string&);
extern template BlockStatus message_from(const std::string&);
extern template CaseAnswer message_from(const std::string&);
extern template GivenUp message_from(const std::string&);
extern template ShelfMessage message_from(const std::string&);
extern template CaseRecord message_from(const std::string&);

}  // namespace ricochet
