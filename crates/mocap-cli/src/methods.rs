use anyhow::Result;
use clap::Args;
use serde_json::json;

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
            println!("{}", serde_json::to_string(&list)?);
            return Ok(());
        }
        for method in gapfill::METHODS {
            println!("{:<10} {}", method.id, method.summary);
            if !method.options.is_empty() {
                println!("{:<10} options: {}", "", method.options.join(" "));
            }
        }
        Ok(())
    }
}
