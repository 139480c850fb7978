#include "sim/files/xml_checks.h"

#include <map>
#include <vector>

#include "sim/files/error.h"
#include "sim/files/text.h"

namespace icloth {
namespace {

constexpr std::size_t kDeepest = 256;
constexpr double kMostNodes = 1e6;

/// Value of an attribute of a start tag, "" where it has none.
std::string_view attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    // The name may also be part of a longer one, or of a value.
    const std::size_t equals = tag.find_first_not_of(" \t\r\n", at + name.size());
    const bool is_whole =
        at > 0 && std::string_view(" \t\r\n").find(tag[at - 1]) != std::string_view::npos;
    if (!is_whole || equals == std::string_view::npos || tag[equals] != '=') continue;
    const std::size_t quote = tag.find_first_not_of(" \t\r\n", equals + 1);
    if (quote == std::string_view::npos || (tag[quote] != '"' && tag[quote] != '\'')) continue;
    return tag.substr(quote + 1, tag.find(tag[quote], quote + 1) - quote - 1);
  }
  return {};
}

/// Which nodes a node holds, directly or by an instance.
struct NodeGraph {
  std::map<std::string, std::size_t, std::less<>> number;  ///< of an id
  std::vector<std::string> name;
  std::vector<std::vector<std::size_t>> children;

  std::size_t add(std::string_view id) {
    const auto known = number.find(id);
    if (!id.empty() && known != number.end()) return known->second;
    const std::size_t n = name.size();
    name.emplace_back(id);
    children.emplace_back();
    if (!id.empty()) number.emplace(std::string(id), n);
    return n;
  }
};

/// Goes through the tags of a text, one after the other.
class XmlChecker {
 public:
  XmlChecker(std::string_view text, const std::string& path) : rest_(text), path_(path) {}

  void check() {
    while (next_tag()) {
    }
    check_graph();
  }

 private:
  /// Drops all up to the end of the word; false when there is no such word.
  bool skip_behind(std::string_view word) {
    const std::size_t at = rest_.find(word);
    rest_.remove_prefix(at == std::string_view::npos ? rest_.size() : at + word.size());
    return at != std::string_view::npos;
  }

  bool next_tag() {
    if (!skip_behind("<")) return false;

    // Comments, literal text and instructions may hold signs that look like tags.
    if (rest_.starts_with("!--")) return skip_behind("-->");
    if (rest_.starts_with("![CDATA[")) return skip_behind("]]>");
    if (rest_.starts_with('?') || rest_.starts_with('!')) return skip_behind(">");

    // A tag ends at the first '>' outside quotes.
    char quote = '\0';
    std::size_t end = 0;
    for (; end < rest_.size() && (quote != '\0' || rest_[end] != '>'); ++end) {
      if (quote == '\0' && (rest_[end] == '"' || rest_[end] == '\''))
        quote = rest_[end];
      else if (rest_[end] == quote)
        quote = '\0';
    }

    const std::string_view tag = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (tag.starts_with('/')) {
      close();
    } else {
      open(tag);
    }
    return true;
  }

  void open(std::string_view tag) {
    const std::string_view name = tag.substr(0, tag.find_first_of(" \t\r\n/"));
    if (name == "instance_node" && !open_nodes_.empty()) {
      std::string_view url = attribute(tag, "url");
      if (url.starts_with('#')) url.remove_prefix(1);
      const std::size_t target = graph_.add(url);
      graph_.children[open_nodes_.back()].push_back(target);
    }

    // A node belongs to the one around it, and holds what comes until it is closed.
    const bool is_node = name == "node";
    if (is_node) {
      const std::size_t node = graph_.add(attribute(tag, "id"));
      if (!open_nodes_.empty()) graph_.children[open_nodes_.back()].push_back(node);
      open_nodes_.push_back(node);
    }

    // Readers go down by recursion: deep files would use up their stack.
    elements_.push_back(is_node);
    if (elements_.size() > kDeepest)
      throw InputError(shown_path(path_) + ": element <" + excerpt(name) +
                       ">: is more than 256 elements deep, expected a flatter file");
    if (tag.ends_with('/')) close();
  }

  void close() {
    if (elements_.empty()) return;
    if (elements_.back()) open_nodes_.pop_back();
    elements_.pop_back();
  }

  /// Counts the nodes that each node becomes when all instances are written out, children first.
  void check_graph() const {
    enum class Mark { unseen, open, done };
    std::vector<Mark> mark(graph_.name.size(), Mark::unseen);
    std::vector<double> count(graph_.name.size(), 1);
    std::vector<std::pair<std::size_t, std::size_t>> stack;  // node, its next child

    // A stack takes the place of recursion, since a file could exhaust that of the program.
    for (std::size_t start = 0; start < mark.size(); ++start) {
      if (mark[start] == Mark::unseen) stack.emplace_back(start, 0);
      while (!stack.empty()) {
        auto& [node, next] = stack.back();
        mark[node] = Mark::open;

        // All children come first; one that is still open holds this node.
        if (next < graph_.children[node].size()) {
          const std::size_t child = graph_.children[node][next++];
          if (mark[child] == Mark::open) refuse(child, "contains itself, expected a tree of nodes");
          if (mark[child] == Mark::unseen) stack.emplace_back(child, 0);
          continue;
        }

        // All of them are counted: the node itself and the nodes of its children.
        for (std::size_t child : graph_.children[node]) count[node] += count[child];
        if (count[node] > kMostNodes) refuse(node, "becomes more than 1000000 nodes by instances");
        mark[node] = Mark::done;
        stack.pop_back();
      }
    }
  }

  [[noreturn]] void refuse(std::size_t node, const char* what) const {
    throw InputError(shown_path(path_) + ": node " + in_quotes(graph_.name[node]) + " " + what);
  }

  std::string_view rest_;
  const std::string& path_;
  std::vector<bool> elements_;           ///< open ones: whether each is a node
  std::vector<std::size_t> open_nodes_;  ///< innermost last
  NodeGraph graph_;
};

}  // namespace

void check_xml(std::string_view text, const std::string& path) { XmlChecker(text, path).check(); }

}  // namespace icloth
