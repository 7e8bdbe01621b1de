// RDKit: stored states as a library of molecules, searched for those that contain a query, by
// screening pattern fingerprints (2048 bits) and then VF2. Links are atoms, their labels elements;
// revolute joints are single bonds, prismatic ones double bonds. Nothing is sanitised, because
// valences mean nothing here.
#include <GraphMol/GraphMol.h>
#include <GraphMol/MolOps.h>
#include <GraphMol/SubstructLibrary/SubstructLibrary.h>

#include "bench.h"

namespace
{

class Library
{
public:
    Library()
        : molecules_(new RDKit::MolHolder), patterns_(new RDKit::PatternHolder),
          library_(molecules_, patterns_)
    {
    }
    void add(const RDKit::ROMol &molecule) { library_.addMol(molecule); }
    unsigned count(const RDKit::ROMol &query, unsigned max)
    {
        return static_cast<unsigned>(
            library_.getMatches(query, false, false, false, 1, static_cast<int>(max)).size());
    }

private:
    boost::shared_ptr<RDKit::MolHolder> molecules_;
    boost::shared_ptr<RDKit::PatternHolder> patterns_;
    RDKit::SubstructLibrary library_;
};

RDKit::RWMol molecule_of(const grrl_graph *graph)
{
    RDKit::RWMol molecule;
    for (unsigned i = 0; i < graph->n; i++) {
        RDKit::Atom atom(static_cast<int>(graph->label[i]) + 5); // boron has 5
        atom.setNoImplicit(true);
        molecule.addAtom(&atom);
    }
    for (unsigned i = 0; i < graph->n; i++)
        for (unsigned j = 0; j < i; j++)
            for (int type = 0; type < GRRL_JOINT_TYPES; type++)
                if ((graph->joined[type][i] >> j & 1u) != 0)
                    molecule.addBond(
                        i, j, type == GRRL_REVOLUTE ? RDKit::Bond::SINGLE : RDKit::Bond::DOUBLE);
    molecule.updatePropertyCache(false);
    RDKit::MolOps::fastFindRings(molecule);
    return molecule;
}

} // namespace

extern "C" void *bench_rdkit_open(void)
{
    return new Library;
}

extern "C" void bench_rdkit_close(void *library)
{
    delete static_cast<Library *>(library);
}

extern "C" void bench_rdkit_add(void *library, const grrl_graph *graph)
{
    static_cast<Library *>(library)->add(molecule_of(graph));
}

extern "C" void *bench_rdkit_query(const grrl_graph *graph)
{
    return new RDKit::RWMol(molecule_of(graph));
}

extern "C" void bench_rdkit_close_query(void *query)
{
    delete static_cast<RDKit::RWMol *>(query);
}

extern "C" unsigned bench_rdkit_count(void *library, const void *query, unsigned max)
{
    return static_cast<Library *>(library)->count(*static_cast<const RDKit::RWMol *>(query), max);
}
