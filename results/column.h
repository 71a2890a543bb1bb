// results/column.h -- a column of a CSV is a field of a row under a name: one table of them writes, reads and
// prints a kind of rows. How a kind is added: CONTRIBUTING.md.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

namespace regather::results {

using Count = std::optional<std::uint64_t>;
using Signed = std::optional<std::int64_t>;
using Flag = std::optional<bool>;
using Number = std::optional<double>;

/// What a row has, for arithmetic.
inline double number(const Count& count) {
    return static_cast<double>(count.value());
}

/// What a cell says. An empty one is a value that does not apply.
enum class Form {
    text,
    name,            ///< A text that is not empty.
    count,           ///< A whole number from 0 up.
    ways,            ///< A count whose 0 is written as "full".
    signed_count,    ///< A whole number.
    flag,            ///< 1 or 0.
    seconds,         ///< From 0 up, with six digits after the point.
    signed_seconds,  ///< As seconds, and below 0 too.
    real,            ///< From 0 up, with as many digits as give the same number back.
    signed_real,     ///< As real, and below 0 too.
};

/// A field of some row.
using Cell = std::variant<std::string*, Count*, Signed*, Flag*, Number*>;

struct Column {
    std::string_view name;
    Form form;
    bool needed;  ///< A file without it is refused.
    Cell (*cell)(void* row);
};

/// A kind of rows: what its files are called and the columns of its CSV in the order in which they are
/// written.
struct RowKind {
    std::string_view name;
    std::span<const Column> columns;
};

namespace detail {

template <class F>
struct FieldOf;
template <class R, class T>
struct FieldOf<T R::*> {
    using Row = R;
    using Type = T;
};

template <class T>
constexpr Form usual_form() {
    if constexpr (std::is_same_v<T, Count>) return Form::count;
    if constexpr (std::is_same_v<T, Signed>) return Form::signed_count;
    if constexpr (std::is_same_v<T, Flag>) return Form::flag;
    if constexpr (std::is_same_v<T, Number>) return Form::real;
    return Form::text;
}

}  // namespace detail

inline constexpr bool needed = true;

/// The column of `field`, as column<&Row::misses>("misses"). R: the kind of row, where the field is of its
/// base.
template <auto field, class R = typename detail::FieldOf<decltype(field)>::Row>
constexpr Column column(std::string_view name, Form form, bool is_needed = false) {
    return {name, form, is_needed, [](void* row) -> Cell { return &(static_cast<R*>(row)->*field); }};
}
template <auto field, class R = typename detail::FieldOf<decltype(field)>::Row>
constexpr Column column(std::string_view name, bool is_needed = false) {
    return column<field, R>(name, detail::usual_form<typename detail::FieldOf<decltype(field)>::Type>(),
                            is_needed);
}

}  // namespace regather::results
