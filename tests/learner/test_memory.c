/* The sizes in docs/memory.md are those of the structs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "grrl/grrl.h"

/* The tables hold for the default capacities on machines with 64-bit pointers. */
#define IS_DEFAULT                                                                                 \
    (GRRL_MAX_LINKS == 16 && GRRL_MAX_JOINTS == 32 && GRRL_MAX_FEATURES == 192 &&                  \
     GRRL_MAX_KEYFRAMES == 48 && GRRL_MAX_PROPERTIES == 8 && GRRL_MAX_SYMBOLS == 32 &&             \
     GRRL_SYMBOL_BYTES == 16 && UINTPTR_MAX == UINT64_MAX)

struct size {
    const char *name;
    size_t bytes;
};

#define SIZE(type)                                                                                 \
    {                                                                                              \
        "`struct " #type "`", sizeof(struct type)                                                  \
    }

static const struct size sizes[] = {
    SIZE(grrl_vec2),
    SIZE(grrl_pose),
    SIZE(grrl_name),
    SIZE(grrl_term_node),
    SIZE(grrl_term_store),
    SIZE(grrl_term_error),
    SIZE(grrl_substitution),
    SIZE(grrl_graph),
    SIZE(grrl_edge),
    SIZE(grrl_signature),
    SIZE(grrl_paths),
    SIZE(grrl_match_step),
    SIZE(grrl_match_growth),
    SIZE(grrl_match_side),
    SIZE(grrl_match_plan),
    SIZE(grrl_match),
    SIZE(grrl_canonical),
    SIZE(grrl_random),
    SIZE(grrl_frame),
    SIZE(grrl_perception_config),
    SIZE(grrl_body),
    SIZE(grrl_joint),
    SIZE(grrl_pair),
    SIZE(grrl_model),
    SIZE(grrl_perception_counts),
    SIZE(grrl_perception_sum),
    SIZE(grrl_perception_window),
    SIZE(grrl_perception_keyframe),
    SIZE(grrl_perception_pose),
    SIZE(grrl_perception),
    SIZE(grrl_noise_track),
    SIZE(grrl_noise),
    SIZE(grrl_trajectory_config),
    SIZE(grrl_trajectory),
    SIZE(grrl_trajectory_model),
    SIZE(grrl_trajectory_fit),
    SIZE(grrl_grounding_config),
    SIZE(grrl_link_frame),
    SIZE(grrl_push),
    SIZE(grrl_q),
    SIZE(grrl_experience_state),
    SIZE(grrl_experience),
    SIZE(grrl_experience_row),
    SIZE(grrl_experience_index),
    SIZE(grrl_experience_store),
    SIZE(grrl_recall_entry),
    SIZE(grrl_recall),
    SIZE(grrl_recall_config),
    SIZE(grrl_io),
    SIZE(grrl_context),
    SIZE(grrl_attempts),
    SIZE(grrl_trial_attempts),
    SIZE(grrl_case_config),
    SIZE(grrl_case),
    SIZE(grrl_case_base),
    SIZE(grrl_estimate),
    SIZE(grrl_view),
    SIZE(grrl_source),
    SIZE(grrl_outcome),
    SIZE(grrl_usage),
    SIZE(grrl_parameter),
    SIZE(grrl_policy_type),
    SIZE(grrl_policy),
    SIZE(grrl_learn_policy),
    SIZE(grrl_paper_config),
    SIZE(grrl_paper_policy),
    SIZE(grrl_choice),
    SIZE(grrl_contexts),
    SIZE(grrl_learner_config),
    SIZE(grrl_decision),
    SIZE(grrl_update),
    SIZE(grrl_learner),
    {"An agent of 100 cases (`learn`)", sizeof(struct grrl_learner) + GRRL_LEARN_POLICY_BYTES(100)},
    {"An agent of 100 experiences (`paper`)",
     sizeof(struct grrl_learner) + GRRL_PAPER_POLICY_BYTES(100)},
};

enum { N_SIZES = sizeof sizes / sizeof sizes[0], LINE_BYTES = 200 };

/* The entry whose name is the first cell of a table's row, or -1. */
static int find_row(const char *line)
{
    for (int i = 0; i < N_SIZES; i++) {
        size_t length = strlen(sizes[i].name);
        if (strncmp(line, "| ", 2) == 0 && strncmp(line + 2, sizes[i].name, length) == 0 &&
            strncmp(line + 2 + length, " | ", 3) == 0)
            return i;
    }
    return -1;
}

static void the_document_tells_the_sizes(void **state)
{
    (void)state;
    if (!IS_DEFAULT)
        skip();
    FILE *file = fopen(GRRL_SOURCE_DIR "/docs/memory.md", "r");
    assert_non_null(file);
    char line[LINE_BYTES];
    unsigned told[N_SIZES] = {0};
    unsigned wrong = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        int row = find_row(line);
        unsigned bytes;
        if (row < 0)
            continue;
        told[row]++;
        const char *cell = line + 2 + strlen(sizes[row].name) + 3;
        if (sscanf(cell, "%u |", &bytes) != 1 || bytes != sizes[row].bytes) {
            print_error("%s takes %zu bytes\n", sizes[row].name, sizes[row].bytes);
            wrong++;
        }
    }
    assert_int_equal(fclose(file), 0);
    for (int i = 0; i < N_SIZES; i++) {
        if (told[i] != 1) {
            print_error("| %s | %zu | has %u rows\n", sizes[i].name, sizes[i].bytes, told[i]);
            wrong++;
        }
    }
    assert_int_equal(wrong, 0);
}

static void every_public_struct_is_listed(void **state)
{
    (void)state;
    const char *const headers[] = {"base/geometry",
                                   "base/random",
                                   "structure/term",
                                   "structure/graph",
                                   "structure/signature",
                                   "structure/match",
                                   "structure/canonical",
                                   "perception/perception",
                                   "perception/noise",
                                   "perception/trajectory",
                                   "learner/grounding",
                                   "learner/policy",
                                   "learner/learner",
                                   "learner/cases/context",
                                   "learner/cases/case_base",
                                   "learner/cases/learn_policy",
                                   "learner/relational_q/experience",
                                   "learner/relational_q/paper_policy",
                                   "base/io"};
    for (size_t h = 0; h < sizeof headers / sizeof headers[0]; h++) {
        char path[LINE_BYTES * 2];
        (void)snprintf(path, sizeof path, "%s/lib/include/grrl/%s.h", GRRL_SOURCE_DIR, headers[h]);
        FILE *file = fopen(path, "r");
        assert_non_null(file);
        char line[LINE_BYTES];
        while (fgets(line, sizeof line, file) != NULL) {
            char name[LINE_BYTES];
            char brace;
            if (sscanf(line, "struct %199s %c", name, &brace) != 2 || brace != '{' ||
                strncmp(line, "struct ", 7) != 0)
                continue;
            char row[LINE_BYTES + 32];
            (void)snprintf(row, sizeof row, "| `struct %s` | ", name);
            if (find_row(row) < 0)
                fail_msg("struct %s is missing here and in docs/memory.md", name);
        }
        assert_int_equal(fclose(file), 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_document_tells_the_sizes),
        cmocka_unit_test(every_public_struct_is_listed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
