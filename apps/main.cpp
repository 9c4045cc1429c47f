// SPDX-License-Identifier: BSD-3-Clause
// The dispatcher: parses the command line, runs one subcommand, turns failures into one line and an
// exit code (0 done, 1 the work failed, 2 the input is at fault).
#include <malloc.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "interrupt.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

constexpr int kWorkFailed = 1;
constexpr int kInputAtFault = 2;

int Fail(int code, std::string message) {
  std::replace(message.begin(), message.end(), '\n', ' ');
  std::cerr << "masked_mapper: " << message << std::endl;
  return code;
}

/// Long and short names of the flags of a command, with their dashes.
std::vector<std::string> FlagsOf(const CLI::App& command) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
    for (const std::string& name : option->get_snames()) flags.push_back("-" + name);
  }
  return flags;
}

/// The parser's complaint, with what was probably meant.
std::string Complaint(const CLI::App& program, const CLI::ParseError& error) {
  const auto chosen = program.get_subcommands();
  const CLI::App& command = chosen.empty() ? program : *chosen.front();
  const std::string place = chosen.empty() ? "" : command.get_name() + ": ";
  const std::string help =
      " (" + (chosen.empty() ? "" : command.get_name() + " ") + "--help explains)";
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) {
    return place + error.what() + help;
  }
  const std::vector<std::string> extras = program.remaining(true);
  for (const std::string& extra : extras) {
    const std::string flag = extra.substr(0, extra.find('='));
    if (flag.rfind('-', 0) == 0) {
      const std::string meant = DidYouMean(flag, FlagsOf(command));
      return place + "unknown flag `" + flag + "`" + (meant.empty() ? help : meant);
    }
  }
  return place + "unexpected argument `" + (extras.empty() ? "" : extras.front()) + "`" + help;
}

/// The first argument names a command; a mistyped one deserves a better answer than the parser's.
std::string UnknownCommand(const CLI::App& program, const std::string& first) {
  const bool is_flag = first.rfind('-', 0) == 0;
  std::vector<std::string> names = is_flag ? FlagsOf(program) : std::vector<std::string>{};
  if (!is_flag) {
    for (const CLI::App* command : program.get_subcommands(nullptr)) {
      names.push_back(command->get_name());
    }
  }
  if (std::find(names.begin(), names.end(), first) != names.end()) return {};
  const std::string meant = DidYouMean(first, names);
  return (is_flag ? "unknown flag `" : "unknown command `") + first + "`" +
         (meant.empty() ? " (--help explains)" : meant);
}

int Main(int argc, char** argv) {
  CLI::App program(
      "Maps buildings from a robot's log: 2D lidar, odometry, and what tells floors "
      "apart.\n\n"
      "  masked_mapper info LOG          what is in a log, and is it sound\n"
      "  masked_mapper map LOG -o OUT    make the map\n"
      "  masked_mapper export OUT ...    write one format of it\n"
      "  masked_mapper route OUT ...     find the shortest way through it\n\n"
      "Every command explains itself with --help. Exit codes: 0 done, 1 the work "
      "failed, 2 the input is at fault.");
  program.name("masked_mapper");
  program.set_version_flag("--version", "masked_mapper " MASKED_MAPPER_VERSION);
  program.require_subcommand(1);
  Run run;
  AddEvaluateCommand(program, run);
  AddExportCommand(program, run);
  AddInfoCommand(program, run);
  AddLocalizeCommand(program, run);
  AddMapCommand(program, run);
  AddRouteCommand(program, run);
  AddSimulateCommand(program, run);

  if (argc < 2)
    return Fail(kInputAtFault,
                "a command is needed: evaluate, export, info, localize, map, route, simulate "
                "(--help explains)");
  const std::string unknown = UnknownCommand(program, argv[1]);
  if (!unknown.empty()) return Fail(kInputAtFault, unknown);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& help) {
    program.exit(help);
    std::cout.flush();
    return std::cout.good() ? 0 : Fail(kWorkFailed, "cannot write to standard output");
  } catch (const CLI::ParseError& error) {
    return Fail(kInputAtFault, Complaint(program, error));
  }
  const int code = run();
  std::cout.flush();
  return std::cout.good() ? code : Fail(kWorkFailed, "cannot write to standard output");
}

/// Local maps, tables and grids come and go by the thousand, of a size that malloc would fetch from
/// the system and give back each time. That each page is then cleared anew was up to a sixth of a
/// run.
void KeepFreedMemory() {
#ifdef M_MMAP_THRESHOLD
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  mallopt(M_TRIM_THRESHOLD, 64 << 20);
#endif
}

}  // namespace
}  // namespace masked_mapper

int main(int argc, char** argv) {
  using masked_mapper::Fail;
  masked_mapper::KeepFreedMemory();
  try {
    return masked_mapper::Main(argc, argv);
  } catch (const masked_mapper::InputError& error) {
    return Fail(masked_mapper::kInputAtFault, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    // A name that no file can have is the user's; all else may be well with another disk.
    const bool is_users = error.code() == std::errc::filename_too_long ||
                          error.code() == std::errc::too_many_symbolic_link_levels;
    return Fail(is_users ? masked_mapper::kInputAtFault : masked_mapper::kWorkFailed,
                error.path1().string() + ": " + error.code().message());
  } catch (const std::bad_alloc&) {
    return Fail(masked_mapper::kWorkFailed, "out of memory");
  } catch (const std::exception& error) {
    return Fail(masked_mapper::kWorkFailed, error.what());
  }
}
