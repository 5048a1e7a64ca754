#pragma once

#include <string>

namespace pixelflex::viewer {

/// Catches what libvncclient would print. Its log functions are global and know no connection, but each session works
/// on a thread of its own: while a log exists, messages written by its thread go into it. One per thread.
class RfbLog {
 public:
  RfbLog();
  ~RfbLog();
  RfbLog(const RfbLog&) = delete;
  RfbLog& operator=(const RfbLog&) = delete;

  /// The last line, without its line end; empty if there was none since clear().
  [[nodiscard]] const std::string& last() const { return last_; }
  /// Set when a line tells of damage that libvncclient does not report otherwise: a corrupt ZRLE stream and a copy from
  /// outside the desktop are logged and then count as success.
  [[nodiscard]] bool damaged() const { return damaged_; }
  void clear() { last_.clear(); }
  void add(std::string line);

 private:
  std::string last_;
  bool damaged_ = false;
};

}  // namespace pixelflex::viewer
