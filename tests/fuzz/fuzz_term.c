/* Terms: what is parsed prints, and what was printed parses to the same; the same of its graph. */
#include <string.h>

#include "fuzz.h"
#include "grrl/structure/canonical.h"
#include "grrl/structure/graph.h"
#include "grrl/structure/term.h"

enum { NODES = 2048, TEXT_BYTES = 65536, BUDGET = 20000 };

static struct grrl_term_node nodes[NODES];
static struct grrl_term_store store;
static char text[TEXT_BYTES];
static char again[TEXT_BYTES];

static void print_and_parse(grrl_term term)
{
    size_t length;
    size_t length_again;
    grrl_term parsed;
    struct grrl_term_error error;
    if (grrl_term_print(&store, term, sizeof text, text, &length) != GRRL_OK)
        return;
    enum grrl_status status = grrl_term_parse(&store, text, length, &parsed, &error);
    if (status == GRRL_ERR_FULL)
        return; /* twice the nodes of the first */
    REQUIRE(status == GRRL_OK);
    REQUIRE(grrl_term_print(&store, parsed, sizeof again, again, &length_again) == GRRL_OK);
    REQUIRE(length == length_again && memcmp(text, again, length) == 0);
}

static void there_and_back(grrl_term term)
{
    struct grrl_graph graph;
    struct grrl_graph back;
    struct grrl_name names[GRRL_MAX_LINKS];
    struct grrl_name names_back[GRRL_MAX_LINKS];
    struct grrl_edge edges[GRRL_MAX_JOINTS];
    uint8_t n_edges;
    struct grrl_term_error error;
    struct grrl_canonical canonical;
    if (grrl_graph_from_term(&store, term, &graph, names, edges, &n_edges, &error) != GRRL_OK)
        return;
    (void)!grrl_canonical_of(&graph, GRRL_ALL_PROPERTIES, BUDGET, &canonical);
    grrl_term rebuilt;
    enum grrl_status status =
        grrl_graph_to_term(&store, &graph, names, edges, n_edges, true, &rebuilt);
    if (status != GRRL_OK)
        return;
    REQUIRE(grrl_graph_from_term(&store, rebuilt, &back, names_back, edges, &n_edges, &error) ==
            GRRL_OK);
    REQUIRE(back.n == graph.n);
    REQUIRE(grrl_graph_joint_count(&back) == grrl_graph_joint_count(&graph));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    grrl_term term;
    struct grrl_term_error error = {.offset = 0};
    grrl_term_store_init(&store, nodes, NODES);
    if (grrl_term_parse(&store, (const char *)data, size, &term, &error) != GRRL_OK) {
        REQUIRE(error.message[0] != '\0' && error.offset <= size);
        return 0;
    }
    print_and_parse(term);
    there_and_back(term);
    return 0;
}
