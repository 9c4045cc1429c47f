// SPDX-License-Identifier: BSD-3-Clause
// masked_mapper evaluate OUT [--relations FILE] [--truth FILE] [--checked OUT...] [--json]
#include <memory>
#include <string>

#include "commands.hpp"
#include "evaluation_output.hpp"
#include "masked_mapper/evaluation/evaluation.hpp"
#include "masked_mapper/text/input_error.hpp"

namespace masked_mapper {
namespace {

struct EvaluateArguments {
  EvaluationInputs inputs;
  bool json = false;
  bool quiet = false;
};

int RunEvaluate(const EvaluateArguments& arguments) {
  const EvaluationInputs& inputs = arguments.inputs;
  if (inputs.relations.empty() && inputs.truth.empty() && inputs.checked.empty()) {
    throw InputError("evaluate: nothing to compare with: give --relations, --truth or --checked");
  }
  const Evaluation evaluation = Evaluate(inputs);
  if (!inputs.truth.empty() && !evaluation.trajectory) {
    throw InputError(inputs.truth + ": no scan of " + inputs.folder + " has a stamp of this truth");
  }
  if (evaluation.relations && evaluation.relations->used == 0) {
    throw InputError(inputs.relations + ": no relation falls inside the trajectory of " +
                     inputs.folder);
  }
  PrintEvaluation(evaluation, arguments.json);
  return 0;
}

}  // namespace

void AddEvaluateCommand(CLI::App& program, Run& run) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = program.add_subcommand("evaluate", "Hold a map against the truth");
  command->add_option("OUT", arguments->inputs.folder, "what `map` wrote")->required();
  command->add_option("--relations", arguments->inputs.relations,
                      "true motions of the robot, lines `t1 t2 x y z roll pitch yaw`");
  command->add_option("--truth", arguments->inputs.truth,
                      "true poses, lines `t x y z qx qy qz qw` or `t x y theta`; a name that ends "
                      "in .truth.tum says that they are exact");
  command
      ->add_option(
          "--checked", arguments->inputs.checked,
          "maps of the same log without false closures: the shortest of their ways are the "
          "true lengths that path lengths are held against")
      ->type_name("OUT...");
  command
      ->add_option("--drive", arguments->inputs.drive,
                   "of a map of several logs: this drive alone, with the stamps of its own log;\n"
                   "from 1, in the order of summary.json")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1000000}))
      ->type_name("N");
  command->add_flag("--json", arguments->json, "as JSON, for programs");
  command->add_flag("--quiet", arguments->quiet, "print errors and the result only");
  command->footer(
      "Floors are read from X.truth_floors.csv beside X.truth.tum. A closure is false when it is\n"
      "off by more than 0.5 m or 5 deg (1 m or 15 deg where the truth is not exact).\n\n"
      "Examples:\n"
      "  masked_mapper evaluate out --relations aces.relations\n"
      "  masked_mapper evaluate out --truth campus.log.truth.tum --json\n"
      "  masked_mapper evaluate out --drive 2 --truth tuesday.log.truth.tum\n"
      "  masked_mapper evaluate out --checked out other-mask");
  command->callback([arguments, &run] { run = [arguments] { return RunEvaluate(*arguments); }; });
}

}  // namespace masked_mapper
