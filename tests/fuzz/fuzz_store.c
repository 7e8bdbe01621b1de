/*
 * Experience files. The first byte tells whether the CRCs are made right first, so that what stands
 * behind them is reached, too. What is loaded saves to the bytes it came from, what is kept of a
 * torn file loads again, and a learner with it perceives, chooses and learns.
 */
#include <string.h>

#include "fuzz.h"
#include "grrl/learner/learner.h"
#include "policy_memory.h"

enum { CAPACITY = 24, MAX_BYTES = 32768, POINTS = 16, TURNS = 8 };

/* The layout of experience.h and case_base.h. */
enum {
    CRC = 4,
    HEADER = 24,
    LINK = 16,
    EXPERIENCE = 26,
    CASES_HEADER = 20,
    LOG_ODDS = 4,
    CASE = 24,
    COUNT_AT = 12
};

struct memory_file {
    uint8_t bytes[MAX_BYTES];
    size_t size;
    size_t at;
};

static POLICY_MEMORY(CAPACITY) memory;
static struct grrl_learner learner;
static struct memory_file file;
static struct memory_file saved;

static int read_bytes(void *context, void *bytes, size_t size)
{
    struct memory_file *from = context;
    if (size > from->size - from->at)
        return -1;
    memcpy(bytes, from->bytes + from->at, size);
    from->at += size;
    return 0;
}

static int write_bytes(void *context, const void *bytes, size_t size)
{
    struct memory_file *to = context;
    if (size > sizeof to->bytes - to->size)
        return -1;
    memcpy(to->bytes + to->size, bytes, size);
    to->size += size;
    return 0;
}

static uint32_t crc_of(uint32_t crc, const uint8_t *bytes, size_t n)
{
    crc = ~crc;
    for (size_t i = 0; i < n; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = (crc >> 1) ^ (UINT32_C(0xedb88320) & (0u - (crc & 1u)));
    }
    return ~crc;
}

/* Where signing stands; past the file's end when it ends within a record. */
struct signer {
    size_t at;
    uint32_t crc;
};

static bool sign_record(struct signer *signer, size_t size)
{
    if (signer->at + size + CRC > file.size) {
        signer->at = file.size;
        return false;
    }
    signer->crc = crc_of(signer->crc, file.bytes + signer->at, size);
    for (unsigned i = 0; i < CRC; i++)
        file.bytes[signer->at + size + i] = (uint8_t)(signer->crc >> (8 * i));
    signer->at += size + CRC;
    return true;
}

static uint32_t number_at(size_t at)
{
    uint32_t number = 0;
    for (unsigned i = 0; i < 4 && at + i < file.size; i++)
        number |= (uint32_t)file.bytes[at + i] << (8 * i);
    return number;
}

/* Of a section that begins where the signer stands; whether it is whole. */
static bool sign_cases(struct signer *signer)
{
    uint32_t n = number_at(signer->at + COUNT_AT);
    signer->crc = 0;
    bool more = sign_record(signer, CASES_HEADER) && sign_record(signer, LOG_ODDS);
    for (uint32_t i = 0; more && i < n; i++)
        more = sign_record(signer, CASE);
    return more;
}

static bool sign_experiences(struct signer *signer)
{
    uint32_t n_states = number_at(signer->at + COUNT_AT);
    uint32_t n_experiences = number_at(signer->at + COUNT_AT + 4);
    bool more = sign_record(signer, HEADER);
    for (uint32_t i = 0; more && i < n_states; i++)
        more = signer->at < file.size &&
               sign_record(signer, 1 + (size_t)file.bytes[signer->at] * LINK);
    for (uint32_t i = 0; more && i < n_experiences; i++)
        more = sign_record(signer, EXPERIENCE);
    return more;
}

/* Makes the CRCs right, as far as the file goes. */
static void sign_file(void)
{
    struct signer signer = {0, 0};
    bool has_experiences = file.size >= 8 && memcmp(file.bytes, "GRRLexp", 8) == 0;
    if (!has_experiences || sign_experiences(&signer))
        (void)sign_cases(&signer);
}

/* Two plates, the second of which turns away while pushed. */
static void watch(bool pushing, float turn)
{
    int32_t id[POINTS];
    float x[POINTS];
    float y[POINTS];
    for (int i = 0; i < POINTS; i++) {
        float along = 0.1f * (float)(i % 8) / 8.0f;
        id[i] = i;
        x[i] = i < 8 ? -along : along;
        y[i] = 0.01f * (float)(i % 3) + (i < 8 ? 0.0f : turn * along);
    }
    const struct grrl_frame frame = {POINTS, id, x, y};
    grrl_learner_observe(&learner, &frame, pushing);
}

static void use(void)
{
    struct grrl_decision decision;
    struct grrl_update update;
    grrl_learner_begin_trial(&learner, 1);
    watch(false, 0.0f);
    REQUIRE(grrl_learner_perceive(&learner) == GRRL_OK);
    REQUIRE(grrl_learner_choose(&learner, &decision) == GRRL_OK);
    for (int i = 0; i < TURNS; i++)
        watch(true, 0.1f * (float)i);
    watch(false, 0.1f * (float)TURNS);
    REQUIRE(grrl_learner_perceive(&learner) == GRRL_OK);
    REQUIRE(grrl_learner_learn(&learner, true, &update) == GRRL_OK);
}

static void init(const struct grrl_policy_type *type)
{
    struct grrl_learner_config config;
    struct grrl_policy policy;
    grrl_learner_config_default(&config);
    REQUIRE(grrl_policy_make(type, memory.bytes, sizeof memory.bytes, CAPACITY, NULL, &policy) ==
            GRRL_OK);
    REQUIRE(grrl_learner_init(&learner, &config, policy) == GRRL_OK);
}

static void save(void)
{
    struct grrl_io out = {.context = &saved, .write = write_bytes};
    saved.size = 0;
    REQUIRE(grrl_learner_save(&learner, &out) == GRRL_OK);
}

/* What was whole of a torn file is a file of its own. */
static void load_what_was_kept(void)
{
    struct grrl_io io = {.context = &file, .read = read_bytes};
    memcpy(file.bytes, saved.bytes, saved.size);
    file.size = saved.size;
    file.at = 0;
    REQUIRE(grrl_learner_load(&learner, &io) == GRRL_OK);
    save();
    REQUIRE(saved.size == file.size && memcmp(saved.bytes, file.bytes, saved.size) == 0);
}

enum { SIGN = 1, BY_PAPER = 2 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0 || size > MAX_BYTES)
        return 0;
    file.size = size - 1;
    file.at = 0;
    memcpy(file.bytes, data + 1, file.size);
    if ((data[0] & SIGN) != 0)
        sign_file();
    struct grrl_io io = {.context = &file, .read = read_bytes};
    uint32_t lost;
    init((data[0] & BY_PAPER) != 0 ? &grrl_policy_paper : &grrl_policy_learn);
    enum grrl_status status = grrl_learner_load_torn(&learner, &io, &lost);
    if (status != GRRL_OK && status != GRRL_ERR_IO) {
        REQUIRE(grrl_learner_usage(&learner).n == 0);
        return 0;
    }
    save();
    if (status == GRRL_OK && saved.size == file.at) /* else of version 0.1.0, with two sections */
        REQUIRE(memcmp(saved.bytes, file.bytes, saved.size) == 0);
    else if (status == GRRL_OK)
        REQUIRE(saved.size < file.at);
    else
        load_what_was_kept();
    use();
    return 0;
}
