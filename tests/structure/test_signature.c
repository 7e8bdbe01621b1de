/* Signatures and paths, against counting one by one what they are counts of. */
#include "grrl/structure/signature.h"
#include "support.h"

enum { SIGNATURE_MOST = 127, PATHS_MOST = 7, CHAINS_MOST = 4096, LONGEST = 6 };

static unsigned at_most(unsigned count, unsigned most)
{
    return count < most ? count : most;
}

static bool is_joined(const struct grrl_graph *graph, uint8_t a, uint8_t b)
{
    return a != b && grrl_graph_joint(graph, a, b) != GRRL_NO_JOINT;
}

static unsigned joints_at(const struct grrl_graph *graph, uint8_t link, int type)
{
    unsigned n = 0;
    for (uint8_t i = 0; i < graph->n; i++)
        n += i != link && grrl_graph_joint(graph, link, i) == type;
    return n;
}

/* Components by giving all links of one the same number, again and again. */
static unsigned count_components(const struct grrl_graph *graph)
{
    uint8_t number[GRRL_MAX_LINKS];
    for (uint8_t i = 0; i < graph->n; i++)
        number[i] = i;
    for (uint8_t round = 0; round < graph->n; round++)
        for (uint8_t a = 0; a < graph->n; a++)
            for (uint8_t b = 0; b < graph->n; b++)
                if (is_joined(graph, a, b) && number[b] > number[a])
                    number[b] = number[a];
    unsigned n = 0;
    for (uint8_t i = 0; i < graph->n; i++)
        n += number[i] == i;
    return n;
}

static void count_shape(const struct grrl_graph *graph, unsigned *count)
{
    unsigned n_joints = 0;
    count[0] = graph->n;
    for (uint8_t i = 0; i < graph->n; i++) {
        unsigned r = joints_at(graph, i, GRRL_REVOLUTE);
        unsigned p = joints_at(graph, i, GRRL_PRISMATIC);
        for (uint8_t j = 0; j < i; j++) {
            count[1] += grrl_graph_joint(graph, i, j) == GRRL_REVOLUTE;
            count[2] += grrl_graph_joint(graph, i, j) == GRRL_PRISMATIC;
            n_joints += is_joined(graph, i, j);
        }
        count[3] += r >= 2;
        count[4] += p >= 2;
        count[5] += r + p >= 3;
        count[6] += r + p >= 4;
    }
    count[7] = n_joints + count_components(graph) - graph->n;
}

/* Chains of three joints with a joint in the middle; its outer ends may be one link. */
static void count_threes(const struct grrl_graph *graph, uint8_t a, uint8_t b, unsigned *count)
{
    int middle = grrl_graph_joint(graph, a, b);
    for (uint8_t x = 0; x < graph->n; x++) {
        for (uint8_t y = 0; y < graph->n; y++) {
            if (x == b || y == a || !is_joined(graph, x, a) || !is_joined(graph, y, b))
                continue;
            int prismatic = grrl_graph_joint(graph, x, a) + grrl_graph_joint(graph, y, b);
            if (middle == GRRL_REVOLUTE)
                count[3 + prismatic]++;
            else
                count[prismatic == 0 ? 6 : 7]++;
        }
    }
}

static void count_short_paths(const struct grrl_graph *graph, unsigned *count)
{
    for (uint8_t i = 0; i < graph->n; i++) {
        for (uint8_t b = 0; b < graph->n; b++) {
            for (uint8_t a = 0; a < b; a++)
                if (is_joined(graph, i, a) && is_joined(graph, i, b))
                    count[grrl_graph_joint(graph, i, a) + grrl_graph_joint(graph, i, b)]++;
            if (b < i && is_joined(graph, i, b))
                count_threes(graph, i, b, count);
        }
    }
}

static unsigned sum_of(uint64_t word)
{
    unsigned sum = 0;
    for (; word != 0; word >>= 8)
        sum += (unsigned)(word & 0xffu);
    return sum;
}

static struct grrl_graph random_graph(struct grrl_random *random, uint32_t max_loops)
{
    uint8_t n = (uint8_t)grrl_random_below(random, GRRL_MAX_LINKS + 1);
    uint32_t loops = n > 1 ? grrl_random_below(random, max_loops + 1) : 0;
    return support_graph(random, n, 4 + grrl_random_below(random, 5), loops, 2);
}

static void test_signatures(void **state)
{
    (void)state;
    struct grrl_random random = support_random("signatures");
    for (int i = 0; i < 3000; i++) {
        struct grrl_graph graph = random_graph(&random, GRRL_MAX_JOINTS - GRRL_MAX_LINKS);
        unsigned shape[8] = {0};
        unsigned paths[8] = {0};
        count_shape(&graph, shape);
        count_short_paths(&graph, paths);
        struct grrl_signature signature;
        grrl_signature_of(&graph, GRRL_ALL_PROPERTIES, &signature);
        for (unsigned k = 0; k < 8; k++) {
            assert_int_equal(signature.word[0] >> 8 * k & 0xffu, shape[k]);
            assert_int_equal(signature.word[1] >> 8 * k & 0xffu, at_most(paths[k], SIGNATURE_MOST));
        }
        assert_int_equal(sum_of(signature.word[2]), graph.n);
        assert_int_equal(sum_of(signature.word[3]), shape[1] + shape[2]);
        if (paths[0] + paths[1] + paths[2] < SIGNATURE_MOST)
            assert_int_equal(sum_of(signature.word[4]), paths[0] + paths[1] + paths[2]);
        uint8_t order[GRRL_MAX_LINKS];
        struct grrl_graph other = support_relabel(&random, &graph, order);
        struct grrl_signature again;
        grrl_signature_of(&other, GRRL_ALL_PROPERTIES, &again);
        assert_memory_equal(&again, &signature, sizeof again);
    }
}

/* Structures of the same shape that differ in labels, or in which joint is which, are mostly told
 * apart by the counts under the mask, and under no mask only where the types differ. */
static void test_labels_count(void **state)
{
    (void)state;
    struct grrl_random random = support_random("labels count");
    unsigned n_apart = 0;
    unsigned n_pairs = 0;
    for (int i = 0; i < 1000; i++) {
        struct grrl_graph graph = support_graph(&random, 6, 8, 1, 1);
        uint8_t a = (uint8_t)grrl_random_below(&random, 6);
        uint8_t b = (uint8_t)grrl_random_below(&random, 6);
        struct grrl_graph other = graph;
        other.label[a] = graph.label[b];
        other.label[b] = graph.label[a];
        struct grrl_signature first;
        struct grrl_signature second;
        grrl_signature_of(&graph, GRRL_NO_PROPERTIES, &first);
        grrl_signature_of(&other, GRRL_NO_PROPERTIES, &second);
        assert_memory_equal(&first, &second, sizeof first);
        grrl_signature_of(&graph, GRRL_ALL_PROPERTIES, &first);
        grrl_signature_of(&other, GRRL_ALL_PROPERTIES, &second);
        assert_int_equal(first.word[2], second.word[2]);
        if (graph.label[a] == graph.label[b])
            continue;
        n_pairs++;
        n_apart += first.word[3] != second.word[3] || first.word[4] != second.word[4];
    }
    print_message("%u of %u told apart\n", n_apart, n_pairs);
    assert_true(n_pairs > 200 && 10 * n_apart > 8 * n_pairs);
}

/* Everything that chains of four to six joints can be, by the types read from either end. */
struct chains {
    unsigned n_directed; /* of one to six joints */
    unsigned n[LONGEST + 1][1 << LONGEST];
};

static void extend(const struct grrl_graph *graph, const uint8_t *link, unsigned joints,
                   struct chains *chains)
{
    for (uint8_t next = 0; next < graph->n; next++) {
        bool is_new = is_joined(graph, link[joints], next);
        for (unsigned i = 0; i < joints; i++)
            is_new = is_new && link[i] != next;
        if (!is_new)
            continue;
        uint8_t longer[LONGEST + 1];
        memcpy(longer, link, joints + 1);
        longer[joints + 1] = next;
        chains->n_directed++;
        unsigned forward = 0;
        unsigned backward = 0;
        for (unsigned i = 0; i <= joints; i++) {
            unsigned type = (unsigned)grrl_graph_joint(graph, longer[i], longer[i + 1]);
            forward |= type << i;
            backward |= type << (joints - i);
        }
        if (next > link[0])
            chains->n[joints + 1][forward < backward ? forward : backward]++;
        if (joints + 1 < LONGEST)
            extend(graph, longer, joints + 1, chains);
    }
}

static unsigned reversed(unsigned types, unsigned joints)
{
    unsigned result = 0;
    for (unsigned i = 0; i < joints; i++)
        result |= (types >> i & 1u) << (joints - 1 - i);
    return result;
}

/* Triples of joints at one link, by how many of them are prismatic. */
static void count_triples(const struct grrl_graph *graph, unsigned *count)
{
    for (uint8_t i = 0; i < graph->n; i++)
        for (uint8_t c = 0; c < graph->n; c++)
            for (uint8_t b = 0; b < c; b++)
                for (uint8_t a = 0; a < b; a++)
                    if (is_joined(graph, i, a) && is_joined(graph, i, b) && is_joined(graph, i, c))
                        count[grrl_graph_joint(graph, i, a) + grrl_graph_joint(graph, i, b) +
                              grrl_graph_joint(graph, i, c)]++;
}

static struct grrl_paths naive_paths(const struct grrl_graph *graph, unsigned *n_directed)
{
    static struct chains chains;
    static const uint8_t place[4] = {4, 8, 10, 12}; /* which are no chain's smaller reading */
    memset(&chains, 0, sizeof chains);
    for (uint8_t i = 0; i < graph->n; i++)
        extend(graph, &i, 0, &chains);
    *n_directed = chains.n_directed;
    unsigned count[16] = {0};
    unsigned triples[4] = {0};
    count_triples(graph, triples);
    for (unsigned i = 0; i < 16; i++)
        count[i] = chains.n[4][i];
    for (unsigned i = 0; i < 4; i++)
        count[place[i]] += triples[i];
    struct grrl_paths paths = {{0}};
    for (unsigned i = 0; i < 16; i++)
        paths.word[i / 8] |= at_most(count[i], PATHS_MOST) << 4 * (i % 8);
    for (unsigned joints = 5; joints <= LONGEST; joints++) {
        for (unsigned types = 0; types < 1u << joints; types++) {
            unsigned other = reversed(types, joints);
            uint32_t *word = &paths.word[joints == 5 ? 2 : 3];
            if (chains.n[joints][types] > 0)
                word[types / 32] |= UINT32_C(1) << types % 32;
            if (chains.n[joints][types] > 1)
                word[other / 32] |= UINT32_C(1) << other % 32;
        }
    }
    return paths;
}

static void test_paths(void **state)
{
    (void)state;
    struct grrl_random random = support_random("paths");
    unsigned n_full = 0;
    for (int i = 0; i < 2000; i++) {
        uint32_t max_loops = i % 8 == 0 ? GRRL_MAX_JOINTS - GRRL_MAX_LINKS : 4;
        struct grrl_graph graph = random_graph(&random, max_loops);
        unsigned n_directed;
        struct grrl_paths expected = naive_paths(&graph, &n_directed);
        struct grrl_paths paths;
        grrl_paths_of(&graph, &paths);
        if (n_directed > CHAINS_MOST) { /* full: three bits of each count, and all of the others */
            expected.word[0] = expected.word[1] = UINT32_C(0x77777777);
            expected.word[2] = expected.word[3] = expected.word[4] = UINT32_MAX;
            n_full++;
        }
        assert_memory_equal(&paths, &expected, sizeof paths);
    }
    assert_true(n_full > 0 || GRRL_MAX_LINKS < 16);
}

/* A part has no more of anything: one count above another is seen, wherever it stands. */
static void test_within(void **state)
{
    (void)state;
    for (int word = 0; word < GRRL_SIGNATURE_WORDS; word++) {
        for (unsigned place = 0; place < 8; place++) {
            struct grrl_signature less = {{0}};
            struct grrl_signature more = {{0}};
            less.word[word] = UINT64_C(6) << 8 * place;
            more.word[word] = UINT64_C(7) << 8 * place;
            assert_true(grrl_signature_within(&less, &more, false));
            assert_true(grrl_signature_within(&more, &more, false));
            assert_false(grrl_signature_within(&more, &less, false));
            assert_int_equal(grrl_signature_within(&more, &less, true),
                             word >= GRRL_SIGNATURE_SHAPE);
        }
    }
    for (int word = 0; word < GRRL_PATH_WORDS; word++) {
        for (unsigned bit = 0; bit < 32; bit++) {
            if (word < GRRL_PATH_COUNTS && bit % 4 == 3)
                continue; /* between counts */
            struct grrl_paths none = {{0}};
            struct grrl_paths one = {{0}};
            one.word[word] = UINT32_C(1) << bit;
            assert_true(grrl_paths_within(&none, &one));
            assert_true(grrl_paths_within(&one, &one));
            assert_false(grrl_paths_within(&one, &none));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_signatures),
        cmocka_unit_test(test_labels_count),
        cmocka_unit_test(test_paths),
        cmocka_unit_test(test_within),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
