// The user's values of the parameters, with undo. The solver follows them between two steps.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sim/scene/parameters.h"

namespace icloth {

/// Keeps the values and their history.
class ParameterEdits {
 public:
  /// Starts from the scene's values, to which a reset returns.
  explicit ParameterEdits(const Parameters& start) : start_(start), values_(start) {}

  const Parameters& values() const { return values_; }
  double value(const ParameterInfo& info) const { return get_parameter(values_, info); }
  double start_value(const ParameterInfo& info) const { return get_parameter(start_, info); }
  bool changed(const ParameterInfo& info) const { return value(info) != start_value(info); }

  /// Sets a value, clamped to its range. With `continued` the change belongs to the one before (a
  /// slider that is still held) and is undone together with it.
  void set(const ParameterInfo& info, double value, bool continued = false);
  /// Takes over all values, each within its range, as one change.
  void set_all(const Parameters& values);
  /// Shows the values that a recorded run has led to; there is nothing to undo about them.
  void follow(const Parameters& values) { values_ = values; }
  void reset(const ParameterInfo& info) { set(info, start_value(info)); }
  /// These return false when there is nothing to undo or redo.
  bool undo();
  bool redo();

  /// Returns the changes since the last call, for the session.
  std::vector<std::pair<std::string, double>> take_changes();

 private:
  struct Change {
    const ParameterInfo* info;
    double before, after;
  };
  using Edit = std::vector<Change>;  ///< undone at once
  void apply(const ParameterInfo& info, double value);

  Parameters start_, values_;
  std::vector<Edit> done_, undone_;
  std::vector<std::pair<std::string, double>> changes_;
};

}  // namespace icloth
