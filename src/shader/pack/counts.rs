//! How many records there are, and what asking them costs.

use std::sync::Arc;

use super::Packed;
use crate::prepare::screen_grid::ScreenGrid;
use crate::shader::format::Format;

impl<F: Format> Packed<F> {
    /// How many there are of each record, and where lists are divided: what the shaders of two formats have to agree
    /// on, since both have the features of one.
    pub fn counts(&self) -> Vec<usize> {
        let mut counts = vec![
            self.objects.len(),
            self.planes.len(),
            self.polygons.len(),
            self.grid_polygons,
            self.spheres.len(),
            self.sphere_points.len(),
            self.quadrics.len(),
            self.bvh.len(),
            self.tiled_planes.len(),
            self.pplanes.len(),
            self.texplanes.len(),
        ];
        if let Some(lit) = &self.lit {
            counts.extend([
                lit.materials.len(),
                lit.lights.len(),
                lit.projectors.len(),
                lit.planes.len(),
                lit.loose_planes,
                lit.third_sides.len(),
                lit.spheres.len(),
                lit.in_tree,
            ]);
        }
        counts
    }

    /// How many objects a primary ray can hit.
    pub fn tested(&self) -> usize {
        self.planes.len() + self.polygons.len() + self.spheres.len() + self.quadrics.len()
    }

    /// About how many tests a pixel costs: a tree's spheres cost by their number's logarithm.
    pub fn tests(&self) -> usize {
        let listed = |screen_grid: &Arc<ScreenGrid>| {
            screen_grid.members.len() / (screen_grid.starts.len() - 1)
        };
        let primary = self.loop_iterations() + self.screen_grid.as_ref().map_or(0, listed);
        let Some(lit) = &self.lit else { return primary };
        // A shadow ray a light, a few times over for mirrors.
        primary + 4 * (1 + lit.lights.len()) * (lit.loop_iterations() + 8 * self.bvh_depth + 4)
    }

    /// Iterations of the loops over objects outside the screen grid, for one primary ray.
    pub fn loop_iterations(&self) -> usize {
        let spheres = match &self.screen_grid {
            Some(_) => 0,
            None => self.spheres.len(),
        };
        self.planes.len() + self.loose_polygons() + self.quadrics.len() + spheres
    }

    /// How many of the polygons are in no cell of the screen.
    pub fn loose_polygons(&self) -> usize {
        self.polygons.len() - self.grid_polygons
    }
}
