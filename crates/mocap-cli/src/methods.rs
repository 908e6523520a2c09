use anyhow::Result;
use clap::Args;
use serde_json::json;

use crate::say::say;

/// List the gap-filling methods
#[derive(Debug, Args)]
pub(crate) struct Methods {
    /// Print one JSON array
    #[arg(long)]
    json: bool,
}

impl Methods {
    pub(crate) fn run(self) -> Result<()> {
        if self.json {
            let list: Vec<_> = gapfill::METHODS
                .iter()
                .map(|m| json!({"id": m.id, "summary": m.summary, "options": m.options}))
                .collect();
            say!("{}", serde_json::to_string(&list)?);
            return Ok(());
        }
        for method in gapfill::METHODS {
            say!("{:<10} {}", method.id, method.summary);
            if !method.options.is_empty() {
                say!("{:<10} options: {}", "", method.options.join(" "));
            }
        }
        Ok(())
    }
}
