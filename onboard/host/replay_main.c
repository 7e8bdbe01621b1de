/* grrl-replay RECORDING: the hashes of a recorded run on this machine. */
#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "replay.h"

static struct onboard_controller controller;
static struct onboard_packet packet;

static const char help[] =
    "Usage: grrl-replay RECORDING\n"
    "Gives a recording of grrl-record to the controller and prints the hashes of what\n"
    "it believed, decided and learned.\n\n"
    "  --help     print this text\n"
    "  --version  print the version\n\n"
    "Exit status: 0 fine; 1 the recording is bad; 2 wrong command line.\n";

static int read_file(void *context, void *bytes, size_t size)
{
    return fread(bytes, 1, size, context) == size ? 0 : -1;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--help") == 0)
        return fputs(help, stdout) < 0;
    if (argc == 2 && strcmp(argv[1], "--version") == 0)
        return puts("grrl-replay " GRRL_VERSION) < 0;
    if (argc != 2 || argv[1][0] == '-') {
        (void)fprintf(stderr, "grrl-replay: expected the name of one recording\n"
                              "Try grrl-replay --help\n");
        return 2;
    }
    FILE *file = fopen(argv[1], "rb");
    if (file == NULL) {
        (void)fprintf(stderr, "grrl-replay: %s: %s\n", argv[1], strerror(errno));
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
