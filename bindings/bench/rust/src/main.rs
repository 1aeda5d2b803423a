//! See ../../step.c.
use std::io::BufRead;
use std::time::Instant;
use voxtet::Grid;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let bytes = std::fs::read(std::env::args().nth(1).ok_or("usage: step SCENE")?)?;
    let words: Vec<[u8; 4]> = bytes.chunks_exact(4).map(|word| word.try_into().unwrap()).collect();
    let number = |i: usize| u32::from_le_bytes(words[i]) as usize;
    let (bodies, frames) = (number(0), number(1));
    let mut at = 2 + 2 * bodies;
    let mut tets: Vec<Vec<[u32; 4]>> = Vec::new();
    for body in 0..bodies {
        let count = number(3 + 2 * body);
        let corners = words[at..at + 4 * count].chunks(4);
        tets.push(corners.map(|tet| std::array::from_fn(|i| u32::from_le_bytes(tet[i]))).collect());
        at += 4 * count;
    }
    let mut positions: Vec<Vec<[f32; 3]>> = Vec::new(); // frame by frame, body by body
    for i in 0..frames * bodies {
        let count = number(2 + 2 * (i % bodies));
        let vertices = words[at..at + 3 * count].chunks(3);
        positions.push(vertices.map(|xyz| std::array::from_fn(|k| f32::from_le_bytes(xyz[k]))).collect());
        at += 3 * count;
    }

    let mut grid = Grid::new()?;
    let mut meshes = Vec::new();
    for body in 0..bodies {
        meshes.push(grid.add(&positions[body], &tets[body])?);
    }
    for line in std::io::stdin().lock().lines() {
        let mut hashes = 0u64;
        let mut least = vec![u128::MAX; 2 * frames];
        for _ in 0..line?.trim().parse()? {
            for frame in 0..frames {
                for body in 0..bodies {
                    grid.positions_mut(meshes[body])?.copy_from_slice(&positions[frame * bodies + body]);
                }
                let begin = Instant::now();
                grid.step()?;
                let stepped = Instant::now();
                for contact in grid.contacts() {
                    hashes = hashes.wrapping_add(contact.vertex.into());
                }
                let end = Instant::now();
                least[2 * frame] = least[2 * frame].min((stepped - begin).as_nanos());
                least[2 * frame + 1] = least[2 * frame + 1].min((end - stepped).as_nanos());
                hashes = hashes.wrapping_add(grid.hash());
            }
        }
        let times: Vec<String> = least.iter().map(u128::to_string).collect();
        println!("{hashes:016x} {}", times.join(" "));
    }
    Ok(())
}
