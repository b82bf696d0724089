//! How a result is shown to a reader: as text for a terminal, and as a page with plots and pictures.
//!
//! - `table`, `block`: tables and the words between them, said once for both
//! - `compared`: a comparison with what it was made of and where, which is also its JSON
//! - `tables`, `summary`, `figures`: its tables; the sentences that sum it up; its plots
//! - `rungs`, `rung_figures`: the tables and the plots of what accuracy costs
//! - `benched`, `growth_figure`: the tables of a benchmark; its plot
//! - `page`: puts these together; `html`: the markup and the style; `folder`: the files
//! - `plot`: axes, points, bars; knows nothing of what they show

mod benched;
mod block;
mod compared;
mod figures;
mod folder;
mod growth_figure;
mod html;
mod page;
mod plot;
mod rung_figures;
mod rungs;
mod summary;
mod table;
mod tables;

pub(crate) use benched::benched;
pub(crate) use block::text;
pub(crate) use compared::Compared;
pub(crate) use folder::{Folder, FolderError};
pub(crate) use growth_figure::growth_figure;
pub(crate) use rungs::rungs;
pub(crate) use table::{Table, maybe, number};
pub(crate) use tables::tables;
