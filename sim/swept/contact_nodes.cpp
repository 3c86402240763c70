#include "sim/swept/contact_nodes.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace pneuma::sim {

void ContactNodes::find(std::span<SweptImpulse* const> impulses) {
  collect(impulses);
  give_numbers();
  find_neighbours();
  order();
}

/// A node for each lever at first, however often it is found.
void ContactNodes::collect(std::span<SweptImpulse* const> impulses) {
  nodes_.clear();
  levers_.clear();
  found_.clear();
  begin_.assign(1, 0);
  const auto add = [&](const void* key, const ContactNode& node, double weight, const Vec3& arm) {
    const int lever = static_cast<int>(levers_.size());
    found_.push_back({key, lever});
    nodes_.push_back(node);
    levers_.push_back({lever, weight, arm});
  };
  for (const SweptImpulse* impulse : impulses) {
    double sign = 1.0;
    for (const SweptSide* side : {&impulse->first(), &impulse->second()}) {
      if (side->box()) add(side->box(), {.box = side->box()}, sign, to_vec3(side->arm()));
      for (std::size_t i = 0; i < side->vertices().size(); ++i) {
        double* vertex = side->vertices()[i];
        add(vertex, {.vertex = vertex, .vertex_mass = side->vertex_mass()}, sign * side->weight(i),
            Vec3::Zero());
      }
      sign = -1.0;
    }
    begin_.push_back(levers_.size());
  }
}

/// In the order in which they are found: it does not depend on where bodies lie in memory.
void ContactNodes::give_numbers() {
  std::ranges::sort(found_, {}, [](const Found& f) { return std::tuple(f.key, f.lever); });
  first_lever_.resize(levers_.size());
  for (std::size_t i = 0; i < found_.size(); ++i) {
    const bool is_first = i == 0 || found_[i].key != found_[i - 1].key;
    const int lever = found_[i].lever;
    first_lever_[at(lever)] = is_first ? lever : first_lever_[at(found_[i - 1].lever)];
  }
  int count = 0;
  for (std::size_t i = 0; i < levers_.size(); ++i) {
    const std::size_t first = at(first_lever_[i]);
    if (first == i) {
      nodes_[at(count)] = nodes_[i];
      levers_[i].node = count++;
    } else {
      levers_[i].node = levers_[first].node;
    }
  }
  nodes_.resize(at(count));
}

void ContactNodes::find_neighbours() {
  const auto for_each_pair = [&](const auto& visit) {
    for (std::size_t i = 0; i < impulses(); ++i) {
      for (const ContactLever& a : levers(i)) {
        for (const ContactLever& b : levers(i)) {
          if (a.node != b.node) visit(a.node, b.node);
        }
      }
    }
  };
  neighbour_begin_.assign(nodes_.size() + 1, 0);
  for_each_pair([&](int a, int) { ++neighbour_begin_[at(a) + 1]; });
  std::partial_sum(neighbour_begin_.begin(), neighbour_begin_.end(), neighbour_begin_.begin());
  filled_.assign(neighbour_begin_.begin(), neighbour_begin_.end());
  neighbours_.resize(at(neighbour_begin_.back()));
  for_each_pair([&](int a, int b) { neighbours_[at(filled_[at(a)]++)] = b; });
}

/// The neighbours of what comes first come next (as Cuthill and McKee's, without their order of
/// degrees).
void ContactNodes::order() {
  queue_.clear();
  is_queued_.assign(nodes_.size(), 0);
  const auto enqueue = [&](int node) {
    if (is_queued_[at(node)]) return;
    is_queued_[at(node)] = 1;
    queue_.push_back(node);
  };
  rows_ = 0;
  std::size_t next = 0;
  for (int start = 0; start < static_cast<int>(nodes_.size()); ++start) {
    enqueue(start);
    for (; next < queue_.size(); ++next) {
      const int node = queue_[next];
      nodes_[at(node)].row = rows_;
      rows_ += nodes_[at(node)].rows();
      for (int i = neighbour_begin_[at(node)]; i < neighbour_begin_[at(node) + 1]; ++i) {
        enqueue(neighbours_[at(i)]);
      }
    }
  }
}

void ContactNodes::first_columns(std::vector<int>& columns) const {
  columns.resize(at(rows_));
  const auto include = [&](const ContactNode& node, int column) {
    for (int row = node.row; row < node.row + node.rows(); ++row) {
      columns[at(row)] = std::min(columns[at(row)], column);
    }
  };
  std::iota(columns.begin(), columns.end(), 0);
  for (const ContactNode& node : nodes_) include(node, node.row);
  for (std::size_t i = 0; i < impulses(); ++i) {
    int first = rows_;
    for (const ContactLever& lever : levers(i)) {
      first = std::min(first, nodes_[at(lever.node)].row);
    }
    for (const ContactLever& lever : levers(i)) include(nodes_[at(lever.node)], first);
  }
}

}  // namespace pneuma::sim
