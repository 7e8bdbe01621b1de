/* fuzz_<name>_replay FILE..: runs each file through the target, as libFuzzer would. */
#include "fuzz.h"

static bool run(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (file == NULL || fseek(file, 0, SEEK_END) != 0) {
        perror(path);
        return false;
    }
    long size = ftell(file);
    rewind(file);
    /* A block of exactly this size: the sanitizer sees a byte too many. */
    uint8_t *data = malloc(size > 0 ? (size_t)size : 1);
    bool good = size >= 0 && data != NULL && fread(data, 1, (size_t)size, file) == (size_t)size;
    if (good)
        (void)LLVMFuzzerTestOneInput(data, (size_t)size);
    else
        (void)fprintf(stderr, "%s: cannot be read\n", path);
    free(data);
    (void)fclose(file);
    return good;
}

int main(int argc, char **argv)
{
    if (argc < 2) {
        (void)fprintf(stderr, "usage: %s FILE..\n", argv[0]);
        return 2;
    }
    for (int i = 1; i < argc; i++)
        if (!run(argv[i]))
            return 1;
    (void)printf("%d inputs\n", argc - 1);
    return 0;
}
