// Standard input, output and error, whatever state the caller left them in.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

namespace pneuma::app {

/// Gives a closed stream its number back, so that no file of ours gets it, and with it what is
/// printed: writing to standard output still fails, and what goes to standard error is dropped.
void open_closed_streams();

/// To standard error. What cannot be shown, because the disk is full or nobody reads the pipe any
/// more, is dropped: a run is worth more than what is said about it.
void write_message(std::string_view text);

template <class... Arguments>
void print_message(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  write_message(fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace pneuma::app
