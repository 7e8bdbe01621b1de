/* grrl-replay RECORDING: prints the hashes of a recorded run on this machine. */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "cli/options.h"
#include "replay.h"

static struct onboard_controller controller;
static struct onboard_packet packet;

static const struct grrl_program program = {
    .name = "grrl-replay",
    .usage = "grrl-replay RECORDING",
    .intro = "Gives a recording of grrl-record to the controller and prints the hashes of what\n"
             "it estimated, decided and learned.\n",
    .outro = "Exit status: 0 success; 1 the recording is invalid; 2 wrong command line.\n",
    .max_arguments = 1,
    .arguments = "give only one recording",
};

static int read_file(void *context, void *bytes, size_t size)
{
    return fread(bytes, 1, size, context) == size ? 0 : -1;
}

int main(int argc, char **argv)
{
    int first;
    enum grrl_options_result parsed = grrl_options_parse(&program, NULL, 0, argc, argv, &first);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    if (first == argc)
        return grrl_options_wrong(&program, "name a recording");
    const char *path = argv[first];
    FILE *file = fopen(path, "rb");
    if (file == NULL) {
        (void)fprintf(stderr, "grrl-replay: %s: %s\n", path, strerror(errno));
        return 1;
    }
    struct onboard_source source = {file, read_file};
    struct onboard_progress progress;
    onboard_controller_init(&controller, NULL);
    enum grrl_status status = onboard_replay(&controller, &source, &packet, &progress);
    (void)fclose(file);
    if (status != GRRL_OK) {
        (void)fprintf(stderr,
                      "grrl-replay: packet %" PRIu32 " (trial %" PRIu32 ", push %" PRIu32
                      " of the run): %s\n",
                      progress.packets, progress.trials, progress.pushes, grrl_status_text(status));
    }
    (void)printf("models %016" PRIx64 "\ndecisions %016" PRIx64 "\nupdates %016" PRIx64
                 "\nstore %016" PRIx64 "\n",
                 controller.hashes.models, controller.hashes.decisions, controller.hashes.updates,
                 controller.store_hash);
    return status == GRRL_OK ? 0 : 1;
}
