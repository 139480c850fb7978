#include "app/window/parameter_edits.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace icloth {

/// Sets a value and notes it for the session; a second change of the same parameter replaces it.
void ParameterEdits::apply(const ParameterInfo& info, double value) {
  set_parameter(values_, info, value);
  if (!changes_.empty() && changes_.back().first == info.name) {
    changes_.back().second = value;
  } else {
    changes_.emplace_back(info.name, value);
  }
}

void ParameterEdits::set(const ParameterInfo& info, double value, bool continued) {
  if (!std::isfinite(value)) return;

  // The value is rounded and kept within its range.
  if (info.field.kind != ParameterInfo::Kind::number) value = std::round(value);
  value = std::clamp(value, info.minimum, info.maximum);
  const double before = this->value(info);

  if (value == before) return;
  apply(info, value);

  // A continued change is one with the change before it, so that one undo takes both back.
  undone_.clear();
  if (continued && !done_.empty() && done_.back().back().info == &info) {
    done_.back().back().after = value;
  } else {
    done_.push_back({{&info, before, value}});
  }
}

void ParameterEdits::set_all(const Parameters& values) {
  Edit edit;
  for (const ParameterInfo& info : parameter_table()) {
    const double before = value(info), after = get_parameter(values, info);
    if (before == after) continue;
    apply(info, after);
    edit.push_back({&info, before, after});
  }
  if (edit.empty()) return;
  undone_.clear();
  done_.push_back(std::move(edit));
}

bool ParameterEdits::undo() {
  if (done_.empty()) return false;
  for (const Change& change : done_.back()) apply(*change.info, change.before);
  undone_.push_back(done_.back());
  done_.pop_back();
  return true;
}

bool ParameterEdits::redo() {
  if (undone_.empty()) return false;
  for (const Change& change : undone_.back()) apply(*change.info, change.after);
  done_.push_back(undone_.back());
  undone_.pop_back();
  return true;
}

std::vector<std::pair<std::string, double>> ParameterEdits::take_changes() {
  return std::exchange(changes_, {});
}

}  // namespace icloth
