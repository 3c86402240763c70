// Command lines as text.
#pragma once

#include <span>
#include <string>

namespace pneuma::app {

/// As one line that a shell reads back to the same arguments.
std::string shell_line(std::span<const std::string> arguments);

/// A shell command as it stands within a string of a Snakefile, whose braces are Snakemake's own.
std::string snakemake_text(const std::string& command);

}  // namespace pneuma::app
