#include "command.hpp"

#include <fstream>

#include "isotherm/base/error.hpp"
#include "isotherm/base/text_writer.hpp"

namespace isotherm::apps {

Verb one_of(CLI::App* parent, std::vector<Verb> subcommands) {
  parent->require_subcommand(1);
  return {parent, [subcommands = std::move(subcommands)] {
            for (const auto& subcommand : subcommands) {
              if (subcommand.parser->parsed()) return subcommand.run();
            }
            return static_cast<int>(kUsage);
          }};
}

void add_common_flags(CLI::App& verb, CommonFlags& flags) {
  const auto group = [](CLI::Option* option) { option->group("Common"); };
  group(verb.add_option("--json", flags.json, "write the result as JSON (- for stdout)")
            ->type_name("FILE"));
  group(verb.add_option("--config", flags.config, "take option values from a JSON file")
            ->type_name("FILE"));
  group(verb.add_flag("--dump-config", flags.dump_config,
                      "print the options in force as JSON and stop"));
  group(verb.add_flag("--strict", flags.strict, "treat every repair of the input as an error"));
  group(verb.add_option("--seed", flags.seed, "seed of all random choices")->capture_default_str());
  group(verb.add_option("--threads", flags.threads, "threads to use; 0: all cores")
            ->capture_default_str()
            ->check(CLI::NonNegativeNumber));
  group(verb.add_flag("-q,--quiet", flags.quiet, "say nothing on stderr but errors"));
  group(verb.add_flag("-v,--verbose", flags.verbose, "say more on stderr"));
  group(verb.add_flag("--no-progress", flags.no_progress, "draw no progress line"));
}

Json read_config(const CommonFlags& flags) {
  if (flags.config.empty()) return Json::object();
  std::ifstream file(flags.config);
  if (!file) throw FileError(flags.config, "cannot be opened");
  Json config;
  try {
    config = Json::parse(file);
  } catch (const nlohmann::json::parse_error& error) {
    throw ParseError({flags.config, 0, 0}, "", std::string("is not valid JSON: ") + error.what());
  }
  if (!config.is_object()) throw ParseError({flags.config, 0, 0}, "", "must hold a JSON object");
  return config;
}

void write_json(const std::string& path, const Json& json) {
  if (path.empty()) return;
  OutputFile file(path);
  file.write(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  file.commit();
}

}  // namespace isotherm::apps
