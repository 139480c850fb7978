#include "sim/files/ring_crossings.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>
#include <vector>

namespace icloth {
namespace {

/// An edge from its left end to its right one; the lower end of an upright edge counts as left.
struct Edge {
  GridPoint left, right;
};

bool cross_each_other(const Edge& e, const Edge& f) {
  const auto sign = [](std::int64_t value) { return (value > 0) - (value < 0); };
  return sign(turn(e.left, e.right, f.left)) * sign(turn(e.left, e.right, f.right)) < 0 &&
         sign(turn(f.left, f.right, e.left)) * sign(turn(f.left, f.right, e.right)) < 0;
}

/// Side of an edge that begins later, against one that the sweep line meets already: above 0 where
/// it is above.
std::int64_t side_of(const Edge& first, const Edge& later) {
  const std::int64_t at_left = turn(first.left, first.right, later.left);
  return at_left != 0 ? at_left : turn(first.left, first.right, later.right);
}

/// Orders edges that the sweep line meets from below to above, those on each other by number.
struct Below {
  const std::vector<Edge>* edges;

  bool operator()(std::size_t i, std::size_t j) const {
    if (i == j) return false;
    const Edge &e = (*edges)[i], &f = (*edges)[j];
    const std::int64_t side = e.left <= f.left ? side_of(e, f) : -side_of(f, e);
    return side != 0 ? side > 0 : i < j;
  }
};

/// An end of an edge. At one place edges end before others begin.
struct Event {
  GridPoint place;
  bool begins;
  std::size_t edge;
  bool operator<(const Event& other) const {
    return std::tie(place, begins, edge) < std::tie(other.place, other.begins, other.edge);
  }
};

}  // namespace

bool crosses_itself(std::span<const GridPoint> ring) {
  // Edges without a length cross nothing.
  std::vector<Edge> edges;
  std::vector<Event> events;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto [left, right] = std::minmax(ring[i], ring[(i + 1) % ring.size()]);
    if (left == right) continue;
    events.push_back({left, true, edges.size()});
    events.push_back({right, false, edges.size()});
    edges.push_back({left, right});
  }
  std::ranges::sort(events, std::less<>{});

  // Two edges that cross are neighbours on the line just before they do.
  using Line = std::set<std::size_t, Below>;
  Line line(Below{&edges});
  std::vector<Line::iterator> place(edges.size());
  for (const Event& event : events) {
    const auto here = event.begins ? line.insert(event.edge).first : place[event.edge];
    const auto above = std::next(here);
    const bool has_below = here != line.begin(), has_above = above != line.end();
    const auto below = has_below ? std::prev(here) : here;

    if (event.begins) {
      place[event.edge] = here;
      if (has_below && cross_each_other(edges[*below], edges[event.edge])) return true;
      if (has_above && cross_each_other(edges[event.edge], edges[*above])) return true;
    } else {
      if (has_below && has_above && cross_each_other(edges[*below], edges[*above])) return true;
      line.erase(here);
    }
  }
  return false;
}

}  // namespace icloth
