#include "sim/state/memory.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "sim/files/error.h"

// Layout of the bytes, little endian, nothing padded:
//
//   "ICLOTHME"  u32 version  u64 length of the payload  payload  u64 check sum of the payload
//
// The payload is the parts in the order of for_each_part: a single value as it is, a list as a
// u64 count and its elements.

namespace icloth {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes are written as they lie");

constexpr char kMagic[8] = {'I', 'C', 'L', 'O', 'T', 'H', 'M', 'E'};
constexpr std::uint32_t kVersion = 6;
constexpr std::size_t kHead = sizeof kMagic + sizeof kVersion + sizeof(std::uint64_t);
constexpr std::size_t kTail = sizeof(std::uint64_t);

/// FNV-1a, to notice a file that was cut or damaged.
std::uint64_t check_sum(std::span<const std::byte> bytes) {
  std::uint64_t sum = 14695981039346656037u;
  for (const std::byte b : bytes) sum = (sum ^ static_cast<std::uint64_t>(b)) * 1099511628211u;
  return sum;
}

template <class T>
constexpr bool kIsList = requires(T& t) {
  t.resize(0);
};

// visit(field) for the numbers, and for the lists, of an element, in the order of the file.

template <class T, class Visit>
requires std::is_arithmetic_v<std::remove_const_t<T>>
void fields(T& value, const Visit& visit) { visit(value); }

template <class V, class Visit>
requires std::is_same_v<std::remove_const_t<V>, Vec3d>
void fields(V& a, const Visit& visit) { visit(a.x), visit(a.y), visit(a.z); }

template <class H, class Visit>
requires std::is_same_v<std::remove_const_t<H>, HeldForceOf<double>>
void fields(H& held, const Visit& visit) {
  visit(held.key);
  fields(held.force, visit);
  visit(held.stuck);
}

template <class L, class Visit>
requires std::is_same_v<std::remove_const_t<L>, LetGo>
void fields(L& entry, const Visit& visit) {
  visit(entry.vertex), visit(entry.body), visit(entry.side);
}

template <class S, class Visit>
requires std::is_same_v<std::remove_const_t<S>, StitchStateOf<double>>
void fields(S& stitch, const Visit& visit) {
  visit(stitch.clock), visit(stitch.mark), visit(stitch.age), visit(stitch.closed);
}

template <class S, class Visit>
requires std::is_same_v<std::remove_const_t<S>, SeamProgress>
void fields(S& seam, const Visit& visit) {
  visit(seam.welded), visit(seam.delay), visit(seam.next);
}

template <class Y, class Visit>
requires std::is_same_v<std::remove_const_t<Y>, FaceYarns>
void fields(Y& yarns, const Visit& visit) {
  for (auto& c : yarns.curvature) visit(c);
  visit(yarns.shear);
}

template <class B, class Visit>
requires std::is_same_v<std::remove_const_t<B>, TrustedBox>
void fields(B& box, const Visit& visit) {
  for (auto& c : box.lo) visit(c);
  for (auto& c : box.hi) visit(c);
}

template <class P, class Visit>
requires std::is_same_v<std::remove_const_t<P>, HeldPatch>
void fields(P& patch, const Visit& visit) {
  visit(patch.id), visit(patch.face);
  fields(patch.barycentric, visit);
  fields(patch.target, visit);
  visit(patch.radius), visit(patch.stiffness);
  for (auto& corner : patch.corners) visit(corner);
  visit(patch.vertices), visit(patch.share), visit(patch.offset);
  fields(patch.followed, visit);
  fields(patch.pulled_to, visit);
  visit(patch.saturation);
}

class Writer {
 public:
  explicit Writer(std::vector<std::byte>& out) : out_(&out) {}

  template <class T>
  void operator()(const T& value) const {
    if constexpr (kIsList<T>) {
      (*this)(std::uint64_t{value.size()});
      for (const auto& element : value) fields(element, *this);
    } else {
      const auto* first = reinterpret_cast<const std::byte*>(&value);
      out_->insert(out_->end(), first, first + sizeof value);
    }
  }
  template <class T>
  void operator()(const MemoryPart&, const T& value) const {
    (*this)(value);
  }

 private:
  std::vector<std::byte>* out_;
};

/// Bytes that an element takes at least; those of lists inside it depend on their length.
template <class T>
std::size_t least_size() {
  T element{};
  std::size_t sum = 0;
  fields(element, [&sum](auto& field) {
    sum += kIsList<std::remove_reference_t<decltype(field)>> ? sizeof(std::uint64_t) : sizeof field;
  });
  return sum;
}

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, std::string source)
      : left_(bytes), source_(std::move(source)) {}

  template <class T>
  void part(const MemoryPart& part, T& value) {
    name_ = part.name;
    read(value);
  }
  template <class T>
  void read(T& value) {
    if constexpr (kIsList<T>)
      read_list(value);
    else
      read_number(value);
  }
  void finish() const {
    if (!left_.empty())
      refuse(std::to_string(left_.size()) + " bytes after the last part, expected none");
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(source_ + ": " + name_ + ": " + what);
  }

  template <class T>
  void read_number(T& value) {
    if (left_.size() < sizeof value)
      refuse("ends after " + std::to_string(left_.size()) + " bytes of a value, expected " +
             std::to_string(sizeof value));

    // Any other byte would be no valid truth value.
    if constexpr (std::is_same_v<T, bool>) {
      const int byte = std::to_integer<int>(left_[0]);
      if (byte > 1) refuse("value " + std::to_string(byte) + ", expected 0 or 1");
      value = byte == 1;
    } else {
      std::memcpy(&value, left_.data(), sizeof value);
    }
    left_ = left_.subspan(sizeof value);
  }

  template <class T>
  void read_list(std::vector<T>& list) {
    std::uint64_t count = 0;
    read_number(count);
    // The check before the memory is taken: a count of a few bytes must not ask for gigabytes.
    const std::size_t most = left_.size() / least_size<T>();
    if (count > most)
      refuse(std::to_string(count) + " elements, expected at most " + std::to_string(most) +
             " in the " + std::to_string(left_.size()) + " bytes that are left");
    list.resize(static_cast<std::size_t>(count));
    for (T& element : list) fields(element, [this](auto& field) { read(field); });
  }

  std::span<const std::byte> left_;
  std::string source_;
  std::string name_ = "memory";
};

template <class T>
T number_at(std::span<const std::byte> bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

/// The part between head and check sum.
std::span<const std::byte> payload_of(std::span<const std::byte> bytes, const std::string& source) {
  const auto require = [&](bool holds, const std::string& what) {
    if (!holds) throw InputError(source + ": " + what);
  };

  // The bytes have to be those of a memory, in the version that this program knows.
  require(bytes.size() >= kHead + kTail, "memory: " + std::to_string(bytes.size()) +
                                             " bytes, expected " + std::to_string(kHead + kTail) +
                                             " or more");
  require(std::memcmp(bytes.data(), kMagic, sizeof kMagic) == 0,
          "memory: begins with other bytes than ICLOTHME, expected a saved memory");
  const auto version = number_at<std::uint32_t>(bytes, sizeof kMagic);
  require(version == kVersion,
          "memory: version " + std::to_string(version) + ", expected " + std::to_string(kVersion));

  // Length and check sum show whether the data were cut off or damaged.
  const std::size_t here = bytes.size() - kHead - kTail;
  const auto length = number_at<std::uint64_t>(bytes, sizeof kMagic + sizeof kVersion);
  require(length == here, "memory: " + std::to_string(here) + " bytes of data, expected " +
                              std::to_string(length) + " as its head says");
  const auto payload = bytes.subspan(kHead, here);
  require(check_sum(payload) == number_at<std::uint64_t>(bytes, kHead + here),
          "memory: the check sum is another, expected undamaged data");
  return payload;
}

[[noreturn]] void refuse_shape(const std::string& what) {
  throw std::invalid_argument("snapshot of another scene: " + what);
}

void check_count(const MemoryPart& part, std::size_t count, const MemoryShape& shape) {
  // Most lists have an entry for each element of one kind.
  Index expected = 0;
  switch (part.extent) {
    case Extent::vertices:
      expected = shape.vertices;
      break;
    case Extent::cloth_vertices:
      expected = shape.cloth_vertices;
      break;
    case Extent::cloth_faces:
      expected = shape.cloth_faces;
      break;
    case Extent::stitches:
      expected = shape.stitches;
      break;
    case Extent::seams:
      expected = shape.seams;
      break;
    case Extent::single:
    case Extent::any:
      return;
  }

  // A list may be empty where the simulation does without it, as it does without yarn friction.
  if (count == static_cast<std::size_t>(expected) || (count == 0 && part.may_be_empty)) return;
  refuse_shape(std::string(part.name) + ": " + std::to_string(count) + " elements, expected " +
               std::to_string(expected) + (part.may_be_empty ? " or none" : ""));
}

void check_hand(const HeldPatch& hand, const MemoryShape& shape) {
  const std::string where = "hand " + std::to_string(hand.id) + ": ";
  const auto require_index = [&](const char* what, Index i, Index count) {
    if (i < 0 || i >= count)
      refuse_shape(where + what + " " + std::to_string(i) + ", expected 0 to " +
                   std::to_string(count - 1));
  };

  require_index("face", hand.face, shape.cloth_faces);
  for (const Index v : hand.corners) require_index("corner", v, shape.cloth_vertices);
  for (const Index v : hand.vertices) require_index("vertex", v, shape.cloth_vertices);

  // Each pulled vertex has its share of the force and its place within the patch.
  if (hand.share.size() != hand.vertices.size() || hand.offset.size() != hand.vertices.size())
    refuse_shape(where + std::to_string(hand.share.size()) + " shares and " +
                 std::to_string(hand.offset.size()) + " offsets, expected " +
                 std::to_string(hand.vertices.size()) + " of each");
}

void check_let_go(const LetGo& entry, const MemoryShape& shape) {
  const auto require = [](bool holds, const char* what, Index value, const std::string& expected) {
    if (!holds)
      refuse_shape(std::string("let_go: ") + what + " " + std::to_string(value) + ", expected " +
                   expected);
  };
  require(entry.vertex >= 0 && entry.vertex < shape.cloth_vertices, "vertex", entry.vertex,
          "0 to " + std::to_string(shape.cloth_vertices - 1));
  require(entry.body >= 0 && entry.body < shape.objects, "body", entry.body,
          "0 to " + std::to_string(shape.objects - 1));
  require(entry.side == 1 || entry.side == -1, "side", entry.side, "1 or -1");
}

}  // namespace

std::size_t memory_bytes(const Snapshot& snapshot) {
  std::size_t sum = sizeof snapshot;
  const auto add = [&sum](const MemoryPart&, const auto& member) {
    if constexpr (requires { member.capacity(); }) sum += member.capacity() * sizeof member[0];
  };
  for_each_part(add, snapshot);
  for (const HeldPatch& hand : snapshot.hands)
    sum += hand.vertices.size() * (sizeof(Index) + sizeof(double) + sizeof(Vec3d));
  return sum;
}

void check_memory(const Snapshot& snapshot, const MemoryShape& shape) {
  const auto check = [&shape](const MemoryPart& part, const auto& member) {
    if constexpr (requires { member.size(); }) check_count(part, member.size(), shape);
  };
  for_each_part(check, snapshot);
  if (snapshot.past.dt > 0 && (snapshot.past.motion.empty() || snapshot.past.change.empty()))
    refuse_shape("past.motion or past.change: no elements, expected those of the step before");
  for (const HeldPatch& hand : snapshot.hands) check_hand(hand, shape);
  for (const LetGo& entry : snapshot.let_go) check_let_go(entry, shape);
}

std::vector<std::byte> memory_to_bytes(const Snapshot& snapshot) {
  std::vector<std::byte> payload;
  for_each_part(Writer(payload), snapshot);

  std::vector<std::byte> bytes;
  bytes.reserve(kHead + payload.size() + kTail);
  const Writer write(bytes);
  for (const char c : kMagic) write(c);
  write(kVersion);
  write(std::uint64_t{payload.size()});
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  write(check_sum(payload));
  return bytes;
}

Snapshot memory_from_bytes(std::span<const std::byte> bytes, const std::string& source) {
  Reader reader(payload_of(bytes, source), source);
  Snapshot snapshot;
  for_each_part([&reader](const MemoryPart& part, auto& member) { reader.part(part, member); },
                snapshot);
  reader.finish();
  return snapshot;
}

}  // namespace icloth
