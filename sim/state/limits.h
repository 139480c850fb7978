// Limits of the settings: where a stage ends, or a step is cut, before it has what it looks for.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace icloth {

/// Each is named as the parameter that sets it.
enum class Limit : std::uint8_t {
  substep_levels,       ///< a substep could not be halved any more
  linearization_error,  ///< a substep was halved since the linear solve left out too much tension
  newton_iterations,    ///< the tension is not as accurate as implicit.newton_tolerance asks
  contact_passes,       ///< the contacts are not as accurate as implicit.contact_tolerance asks
  cg_iterations,        ///< the residual is larger than implicit.cg_tolerance
  zone_iterations,      ///< an impact zone ended before it was solved
  zone_rounds,          ///< impacts were left after the last round
  zone_correction,      ///< a substep was halved since its correction would tear the fabric
  hand_speed,           ///< a hand lags behind the mouse
  hand_force,           ///< a hand pulls with less than its spring asks
};
inline constexpr int kLimitCount = 10;

/// The dotted name of the parameter, for example "implicit.cg_max_iterations".
std::string_view parameter_of(Limit limit);

/// The bit of a limit in a set of them.
constexpr std::int64_t bit_of(Limit limit) { return std::int64_t{1} << static_cast<int>(limit); }

/// The names of the parameters whose bits are set, in the order of `Limit`.
std::vector<std::string_view> names_of_limits(std::int64_t bits);

}  // namespace icloth
