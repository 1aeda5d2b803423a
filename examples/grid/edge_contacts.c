/* Edge contacts: two bars laid across each other. No vertex of one is in the other; edges of one pass through
 * faces of the other, and the way out is up, by as much as they overlap. */
#include "example.h"

/* A cube, 9 times as long along one axis, around its middle. */
static cube bar_along(int axis, float z) {
    cube bar = cube_at(0, 0, z);
    for (int v = 0; v < 8; ++v) bar.positions[v][axis] = 9 * (bar.positions[v][axis] - 0.5f) + 0.5f;
    return bar;
}

int main(void) {
    cube below = bar_along(0, 0), above = bar_along(1, 0.75f);
    vox_grid_desc desc = vox_default_grid_desc();
    desc.flags |= VOX_GRID_EDGE_CONTACTS;
    vox_grid* grid = NULL;
    must(vox_grid_create(&desc, &grid));
    vox_body ids[2];
    vox_mesh_desc bars[2] = {cube_desc(&below), cube_desc(&above)};
    for (int i = 0; i < 2; ++i) must(vox_mesh_insert(grid, &bars[i], &ids[i]));

    vox_contact_view contacts;
    vox_edge_contact_view edges;
    vox_depth_view depths;
    must(vox_grid_step(grid));
    must(vox_grid_get_contacts(grid, &contacts));
    must(vox_grid_edge_contacts(grid, &edges));
    must(vox_grid_prepare_edge_depths(grid)); /* the way out, for those who want it */
    must(vox_grid_edge_depths(grid, &depths));
    printf("%" PRIu64 " contacts, %s\n", contacts.count,
           edges.count > 0 ? "and edge contacts" : "no edge contacts");
    uint64_t deepest = 0;
    for (uint64_t i = 0; i < edges.count; ++i) {
        const int is_first = edges.data[deepest].body_a != ids[1];
        if (edges.data[i].body_a == ids[1] && (is_first || depths.data[i].depth > depths.data[deepest].depth))
            deepest = i;
    }
    const vox_edge_contact* c = &edges.data[deepest];
    const vox_depth* out = &depths.data[deepest];
    printf(
        "edge %u %u of the upper bar enters the lower one at y = %g; the way out is %g along (%g, %g, %g)\n",
        (unsigned)c->edge[0], (unsigned)c->edge[1], c->position[1], out->depth, out->direction[0],
        out->direction[1], out->direction[2]);

    move_cube(&above, 0, 0, (float)out->depth + 0.01f);
    must(vox_grid_step(grid));
    must(vox_grid_edge_contacts(grid, &edges));
    uint64_t hash; /* of all of them: the same on every machine */
    must(vox_grid_edge_hash(grid, &hash));
    printf("moved out: %" PRIu64 " edge contacts, hash %016" PRIx64 "\n", edges.count, hash);
    vox_grid_destroy(grid);
    return 0;
}
