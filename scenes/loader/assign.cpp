#include "scenes/loader/assign.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenes/loader/make_keys.h"
#include "scenes/loader/text_checks.h"
#include "sim/base/nearest.h"

namespace pneuma::scenes {
namespace {

/// Thrown and caught in this file only: the first thing wrong with a value.
struct Refusal {
  Complaint complaint;
};

class Assignment {
 public:
  Assignment(const Key& key, const Value& value) : key_(key), value_(value) {}

  void operator()(std::monostate) const {}
  void operator()(double* member) const { *member = number(value_, key_.name); }
  void operator()(int* member) const { *member = static_cast<int>(integer(value_, key_.name)); }
  void operator()(std::uint64_t* member) const {
    *member = static_cast<std::uint64_t>(integer(value_, key_.name));
  }
  void operator()(bool* member) const { *member = flag(); }
  void operator()(std::string* member) const { *member = text(value_); }
  void operator()(Vec3* member) const { *member = vector(); }
  void operator()(std::optional<int>* member) const {
    *member = static_cast<int>(integer(value_, key_.name));
  }
  void operator()(std::optional<double>* member) const { *member = number(value_, key_.name); }
  void operator()(std::optional<Vec3>* member) const { *member = vector(); }

  void operator()(std::array<int, 3>* member) const {
    const Array& elements = array_of_three("whole numbers");
    std::array<int, 3> result = {};
    for (std::size_t i = 0; i < 3; ++i) {
      result[i] = static_cast<int>(integer(elements[i], element_name(i)));
    }
    *member = result;
  }

  void operator()(std::vector<std::string>* member) const {
    const auto* elements = std::get_if<Array>(&value_.data);
    if (const auto* single = std::get_if<std::string>(&value_.data)) {
      text(value_);
      refuse(value_, fmt::format("{0}: expected an array of 1 to 3 strings; write [\"{1}\"]",
                                 key_.name, base::printable(*single)));
    }
    if (elements == nullptr || elements->empty() || elements->size() > 3) {
      refuse_type(value_, key_.name, "an array of 1 to 3 strings");
    }
    std::vector<std::string> result;
    for (const Value& element : *elements) result.push_back(text(element));
    *member = std::move(result);
  }

  void operator()(std::vector<sim::KeyFrame>* member) const {
    set_rows(*member, "an array of rows [time, x, y, z]",
             [this](const Value& row) { return key_frame(row); });
  }

  void operator()(std::vector<TimedValue>* member) const {
    set_rows(*member, "an array of rows [time, value]",
             [this](const Value& row) { return timed_value(row); });
  }

  void operator()(std::vector<CameraKey>* member) const {
    set_rows(*member, "an array of rows [time, eye x, y, z, target x, y, z]",
             [this](const Value& row) { return camera_key(row); });
  }

  void operator()(std::vector<Region>* member) const {
    const auto* rows = std::get_if<Array>(&value_.data);
    if (rows == nullptr || rows->empty()) {
      refuse_type(value_, key_.name, "an array of rows [xmin, ymin, zmin, xmax, ymax, zmax]");
    }
    std::vector<Region> regions;
    for (const Value& row : *rows) regions.push_back(region(row));
    *member = std::move(regions);
  }

  void operator()(std::optional<sim::ContactMaterial>* member) const {
    const bool present = flag();
    if (present && !*member) *member = sim::ContactMaterial{};
    if (!present) member->reset();
  }

  void operator()(const Word& word) const {
    const auto* given = std::get_if<std::string>(&value_.data);
    if (given == nullptr) refuse_type(value_, key_.name, "a word in quotes");
    const auto found = std::find(word.words.begin(), word.words.end(), *given);
    if (found == word.words.end()) {
      refuse(value_, fmt::format("{}: unknown word {}{}", key_.name, base::in_quotes(*given),
                                 base::suggestion_and_all(*given, word.words)));
    }
    word.set(static_cast<std::size_t>(found - word.words.begin()));
  }

 private:
  [[noreturn]] static void refuse(const Value& value, std::string message) {
    throw Refusal{{value.at, std::move(message)}};
  }

  [[noreturn]] static void refuse_type(const Value& value, std::string_view name,
                                       std::string_view expected) {
    refuse(value, fmt::format("{}: expected {}, got {}", name, expected, describe(value)));
  }

  template <class Number>
  void check_range(const Value& value, std::string_view name, Number number) const {
    if (key_.range.contains(static_cast<double>(number))) return;
    const std::string unit = key_.unit.empty() ? std::string() : fmt::format(" {}", key_.unit);
    refuse(value, fmt::format("{} = {}{} is out of range; allowed: {}{} ({})", name, number, unit,
                              key_.range.text(key_.name), unit, key_.meaning));
  }

  double number(const Value& value, std::string_view name) const {
    const double result = finite(value, name, key_.unit);
    check_range(value, name, result);
    return result;
  }

  double finite(const Value& value, std::string_view name, std::string_view unit) const {
    double result = 0.0;
    if (const auto* whole = std::get_if<std::int64_t>(&value.data)) {
      result = static_cast<double>(*whole);
    } else if (const auto* real = std::get_if<double>(&value.data)) {
      result = *real;
    } else {
      const auto* text = std::get_if<std::string>(&value.data);
      refuse(value, fmt::format("{}: expected a number, got {}{}", name, describe(value),
                                text == nullptr ? std::string() : number_hint(*text)));
    }
    if (!std::isfinite(result)) {
      refuse(value, fmt::format("{} = {} is not finite; write a finite number{}{}", name, result,
                                unit.empty() ? "" : " of ", unit));
    }
    return result;
  }

  std::int64_t integer(const Value& value, std::string_view name) const {
    const auto* whole = std::get_if<std::int64_t>(&value.data);
    if (whole == nullptr) refuse_type(value, name, "a whole number");
    check_range(value, name, *whole);
    return *whole;
  }

  bool flag() const {
    const auto* result = std::get_if<bool>(&value_.data);
    if (result == nullptr) refuse_type(value_, key_.name, "true or false");
    return *result;
  }

  std::string text(const Value& value) const {
    if (const auto* whole = std::get_if<std::int64_t>(&value.data); whole && key_.or_number) {
      return fmt::format("{}", *whole);
    }
    const auto* result = std::get_if<std::string>(&value.data);
    if (result == nullptr) {
      refuse_type(value, key_.name,
                  key_.or_number ? "a string in quotes or a whole number" : "a string in quotes");
    }
    const std::string reason = key_.check == nullptr ? std::string() : key_.check(*result);
    if (!reason.empty())
      refuse(value, fmt::format("{}: {} {}", key_.name, base::in_quotes(*result), reason));
    return *result;
  }

  const Array& array_of_three(std::string_view what) const {
    const auto* elements = std::get_if<Array>(&value_.data);
    if (elements == nullptr || elements->size() != 3) {
      refuse_type(value_, key_.name, fmt::format("an array of 3 {}", what));
    }
    return *elements;
  }

  Vec3 vector() const {
    const Array& elements = array_of_three("numbers");
    Vec3 result;
    for (int i = 0; i < 3; ++i) {
      const auto index = static_cast<std::size_t>(i);
      result[i] = number(elements[index], element_name(index));
    }
    return result;
  }

  /// Rows of rising times.
  template <class Row, class Read>
  void set_rows(std::vector<Row>& member, std::string_view expected, const Read& read) const {
    const auto* rows = std::get_if<Array>(&value_.data);
    if (rows == nullptr || rows->empty()) refuse_type(value_, key_.name, expected);
    std::vector<Row> keys;
    for (const Value& row : *rows) {
      keys.push_back(read(row));
      check_times(row, keys);
    }
    member = std::move(keys);
  }

  /// s, of a row, whatever the range of its values is.
  double time(const Value& value) const {
    const double seconds = finite(value, fmt::format("{} time", key_.name), time_unit);
    if (seconds >= 0.0 && seconds <= longest_duration) return seconds;
    refuse(value,
           fmt::format("{}: a time of {} {} is {}; allowed: 0 to {:.0f}", key_.name, seconds,
                       time_unit, seconds < 0.0 ? "before the start" : "after the longest run",
                       longest_duration));
  }

  TimedValue timed_value(const Value& row) const {
    const auto* elements = std::get_if<Array>(&row.data);
    if (elements == nullptr || elements->size() != 2) {
      refuse_type(row, key_.name, "a row [time, value]");
    }
    return {time((*elements)[0]), number((*elements)[1], key_.name)};
  }

  /// A time, then places along x, y, z.
  template <class Key>
  Key timed_row(const Value& row, std::string_view expected) const {
    Key key{};
    const auto* elements = std::get_if<Array>(&row.data);
    if (elements == nullptr || elements->size() != key.size()) {
      refuse_type(row, key_.name, expected);
    }
    key[0] = time(elements->front());
    for (std::size_t i = 1; i < key.size(); ++i) {
      key[i] = number((*elements)[i], element_name((i - 1) % 3));
    }
    return key;
  }

  sim::KeyFrame key_frame(const Value& row) const {
    return timed_row<sim::KeyFrame>(row, "a row [time, x, y, z]");
  }

  CameraKey camera_key(const Value& row) const {
    const auto key = timed_row<CameraKey>(row, "a row [time, eye x, y, z, target x, y, z]");
    if (std::equal(key.begin() + 1, key.begin() + 4, key.begin() + 4)) {
      refuse(row, fmt::format("{}: eye and target of {} s are the same point, so the camera looks "
                              "nowhere",
                              key_.name, key[0]));
    }
    return key;
  }

  /// `row` is the last of the keys.
  template <class Key>
  void check_times(const Value& row, const std::vector<Key>& keys) const {
    if (keys.size() < 2 || keys.back()[0] > keys[keys.size() - 2][0]) return;
    refuse(row, fmt::format("{}: the row of {} s follows that of {} s; times must rise", key_.name,
                            keys.back()[0], keys[keys.size() - 2][0]));
  }

  Region region(const Value& row) const {
    const auto* elements = std::get_if<Array>(&row.data);
    if (elements == nullptr || elements->size() != 6) {
      refuse_type(row, key_.name, "a row [xmin, ymin, zmin, xmax, ymax, zmax]");
    }
    Region ends;
    for (std::size_t i = 0; i < 6; ++i) ends[i] = number((*elements)[i], element_name(i % 3));
    for (std::size_t i = 0; i < 3; ++i) {
      if (ends[i] <= ends[i + 3]) continue;
      refuse((*elements)[i + 3],
             fmt::format("{} from {} m to {} m; a box ends where it begins or beyond",
                         element_name(i), ends[i], ends[i + 3]));
    }
    return ends;
  }

  std::string element_name(std::size_t i) const {
    constexpr std::string_view axes = "xyz";
    return fmt::format("{} {}", key_.name, axes[i]);
  }

  const Key& key_;
  const Value& value_;
};

}  // namespace

std::optional<Complaint> assign(const Key& key, const Value& value) {
  try {
    std::visit(Assignment(key, value), key.slot);
  } catch (const Refusal& refusal) {
    return refusal.complaint;
  }
  return std::nullopt;
}

}  // namespace pneuma::scenes
