"""What the cell size changes and what it does not: the work of a step of the paper's algorithm, counted, at sizes around the
suggested one, and the contacts, which are the same at all of them."""

import voxtet
import voxtet.io

ball = voxtet.io.make_ball(1.0, 0.1)
first, second = ball.positions, ball.positions + [1.9, 0.2, 0.1]
suggested = voxtet.suggest_cell_size(ball.positions, ball.tets)
mean_edge = voxtet.measure_geometry(ball.positions, ball.tets).mean_edge
print(
    f"{len(ball.tets)} tetrahedra each, mean edge {mean_edge:.3f}, suggested {suggested.cell_size / mean_edge:.2f} mean edges"
)

hashes = set()
for edges in (0.35, 0.7, suggested.cell_size / mean_edge, 2.8, 5.6):
    with voxtet.Grid(edges * mean_edge, reference=voxtet.Reference()) as grid:
        grid.add(first, ball.tets)
        grid.add(second, ball.tets)
        grid.step()
        work = grid.counters
        print(
            f"{edges:4.2f} mean edges: {work['visited_cells']:8} cells visited, {work['visited_entries']:8} vertices met, {len(grid.contacts)} contacts"
        )
        hashes.add(grid.hash)
print("the same contacts" if len(hashes) == 1 else "a defect")
